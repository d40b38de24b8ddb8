// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/plan_world.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace trussmap::planning {
namespace {

constexpr std::uint64_t kAnySeed = 1;  // of which landmarks are recognised from afar
constexpr double kExactly = 1e-4;      // m: the survey by which the fit begins
constexpr double kTruthEvery = 1.0;    // s

void add_truth(const TrueMotion& motion, Recording& recording) {
  double last = -kTruthEvery;
  for (const TrueRow& row : motion.rows) {
    if (row.t - last < kTruthEvery) continue;
    recording.truth.push_back({row.t, row.pose.x, row.pose.y, wrap_angle(row.pose.heading)});
    last = row.t;
  }
}

/// Columns that nobody sets, as the recordings call them.
void name_columns(const PlanWorld& world, Recording& recording) {
  for (const ColumnInTime& one : world.columns) {
    std::vector<double> values;
    std::size_t at = 0;
    for (const double t : recording.drive.t) {
      while (at + 1 < one.from.size() && one.from[at + 1] <= t) ++at;
      values.push_back(one.values[at]);
    }
    const auto there =
        std::find_if(recording.drive.covariates.begin(), recording.drive.covariates.end(),
                     [&one](const Covariate& other) { return other.name == one.name; });
    if (there == recording.drive.covariates.end()) {
      recording.drive.covariates.push_back({one.name, std::move(values)});
    } else {
      there->values = std::move(values);
    }
  }
}

/// The start and the nearest landmarks by routes.
std::vector<int> near(int start, const RouteNetwork& routes) {
  constexpr std::size_t kMostPlaces = 30;
  std::vector<int> found;
  std::vector<bool> done(routes.names.size(), false);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(0.0, start);
  while (!queue.empty() && found.size() < kMostPlaces) {
    const auto [way, here] = queue.top();
    queue.pop();
    if (done[idx(here)]) continue;
    done[idx(here)] = true;
    found.push_back(here);
    for (const int to : routes.exits[idx(here)]) {
      queue.emplace(way + (routes.positions[idx(to)] - routes.positions[idx(here)]).norm(), to);
    }
  }
  return found;
}

}  // namespace

void lay_near(int start, const RouteNetwork& routes, PlanWorld& world) {
  const std::vector<int> places = near(start, routes);
  std::vector<int> numbers(routes.names.size(), -1);
  for (const int place : places) {
    numbers[idx(place)] = static_cast<int>(world.mesh.names.size());
    world.mesh.names.push_back(routes.names[idx(place)]);
    world.mesh.positions.push_back(routes.positions[idx(place)]);
  }
  for (const int place : places) {
    world.exits.emplace_back();
    for (const int to : routes.exits[idx(place)]) {
      if (numbers[idx(to)] >= 0) world.exits.back().push_back(numbers[idx(to)]);
    }
  }
  world.mesh.size = {static_cast<int>(world.mesh.names.size()), 1};
}

DrivenRecording planned_recording(const PlanWorld& world, const DrivePlan& plan) {
  DrivingStyle style;
  style.standing = 0.0;
  SimulatedDrive drive = simulate_plan(world.mesh, plan, style, world.robot, kAnySeed);
  Recording& recording = drive.recording;
  recording.name = "plan";
  name_columns(world, recording);
  if (world.truth) add_truth(drive.motion, recording);
  for (SurveyPoint& point : recording.survey) point.sd = kExactly;
  return with_wheels(std::move(recording), world.model.robot);
}

fitting::FitState planned_fit(const PlanWorld& world, const DrivePlan& plan) {
  fitting::FitterOptions how;
  how.fit_effects = false;
  how.relinearise = false;
  how.landmark_uncertainties = false;
  how.max_rounds = 1;
  return fitting::fit_recordings({planned_recording(world, plan)}, world.model, how);
}

}  // namespace trussmap::planning
