// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/plan_world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap {
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

}  // namespace

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

FitState planned_fit(const PlanWorld& world, const DrivePlan& plan) {
  FitterOptions how;
  how.fit_effects = false;
  how.relinearise = false;
  how.landmark_uncertainties = false;
  how.max_rounds = 1;
  return fit_recordings({planned_recording(world, plan)}, world.model, how);
}

}  // namespace trussmap
