// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A truck with steering and GPS (Guivant & Nebot, 2001; "Victoria Park") as a recording.
//
//   PREFIX_dr.mat     time [ms], speed [m/s] of the rear left wheel, steering [rad]
//   PREFIX_gpsx.mat   timeGps [ms], Lo_m, La_m: to the east and to the north [m]
//   victoriaPark.txt  beside them, may be absent: the graph that comes with iSAM, plain or .xz; of
//                     ODOMETRY pose, next pose, dx, dy, dtheta; of LANDMARK pose, tree, x, y
//                     [m, rad, ahead and to the left of the rear axle's centre]
//
// MATLAB files of level 5. A speed and a steering angle hold from their row's time until the next
// row's. The graph has no times; but its odometry is that of the same log, summed up row by row
// from one laser frame to the next, to all its digits: so every edge is found again in the log, and
// its trees are sightings by range and bearing at the ends of rows.
#include "datasets/formats.hpp"
#include "datasets/mat_columns.hpp"
#include "datasets/number_rows.hpp"
#include "datasets/truck_trees.hpp"
#include "files/present.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;
using Columns = std::map<std::string, std::vector<double>>;

constexpr double kAxles = 2.83;      // m, rear to front
constexpr double kWheelLeft = 0.76;  // m, of the wheel with the encoder

fs::path drive_file(const fs::path& prefix) {
  return prefix.string() + "_dr.mat";
}

fs::path fixes_file(const fs::path& prefix) {
  return prefix.string() + "_gpsx.mat";
}

/// Empty: there is none.
fs::path graph_file(const fs::path& prefix) {
  return plain_or_xz(prefix.parent_path() / "victoriaPark.txt");
}

/// Of the rear axle's centre, by the truck's stated measures.
std::vector<BodyStep> steps_of(const Drive& drive) {
  std::vector<BodyStep> steps;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double curvature = std::tan(drive.covariates[1].values[row]) / kAxles;
    const double ahead = drive.covariates[0].values[row] / (1.0 - kWheelLeft * curvature);
    steps.push_back({ahead, ahead * curvature});
  }
  return steps;
}

}  // namespace

bool is_steered_truck(const fs::path& prefix) {
  return files::is_present(drive_file(prefix)) || files::is_present(fixes_file(prefix));
}

Dataset read_steered_truck(const fs::path& prefix) {
  Dataset result;
  int repeated_fixes = 0;
  int graph_poses = 0;
  Robot& robot = result.model.robot;
  robot.drive = DriveKind::ackermann;
  robot.length = robot.wheelbase = kAxles;
  robot.wheel_left = kWheelLeft;
  robot.columns = {"wheel", "steer"};
  result.model.noise.left = result.model.noise.right = 0.05;
  result.model.noise.steer = 0.01;
  result.model.noise.fix = 0.5;

  const fs::path driven = drive_file(prefix);
  const Columns drive = read_mat_columns(driven);
  const std::vector<double>& time = mat_column(drive, "time", driven);
  const std::vector<double>& speed = mat_column(drive, "speed", driven, time.size());
  const std::vector<double>& steering = mat_column(drive, "steering", driven, time.size());
  Recording& recording = result.recording;
  recording.name = prefix.string();
  recording.drive.covariates = {{"wheel", {}}, {"steer", {}}};
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (!(time[k] > time[k - 1])) {
      throw InputError(driven.string(), 0,
                       "time runs backwards in row " + std::to_string(k + 1) +
                           ", expected rows in order of time");
    }
    recording.drive.t.push_back(1e-3 * (time[k] - time[0]));
    recording.drive.covariates[0].values.push_back(speed[k - 1] * 1e-3 * (time[k] - time[k - 1]));
    recording.drive.covariates[1].values.push_back(steering[k - 1]);
    io::SourceLine(driven.string() + ", row " + std::to_string(k + 1), 0)
        .expect_last_row(recording.drive);
  }
  if (recording.drive.rows() < 2) {
    throw InputError(driven.string(), 0, "has fewer than three rows, expected a drive");
  }
  const fs::path received = fixes_file(prefix);
  const Columns fixes = read_mat_columns(received);
  const std::vector<double>& stamped = mat_column(fixes, "timeGps", received);
  const std::vector<double>& east = mat_column(fixes, "Lo_m", received, stamped.size());
  const std::vector<double>& north = mat_column(fixes, "La_m", received, stamped.size());
  for (std::size_t k = 0; k < stamped.size(); ++k) {
    if (k > 0 && !(stamped[k] > stamped[k - 1])) {
      ++repeated_fixes;
      continue;
    }
    recording.fixes.push_back({1e-3 * (stamped[k] - time[0]), east[k], north[k]});
    io::SourceLine(received.string() + ", row " + std::to_string(k + 1), 0)
        .expect(recording.fixes.back());
  }
  const fs::path graph = graph_file(prefix);
  if (!graph.empty()) {
    graph_poses = take_trees(graph, steps_of(recording.drive), recording);
    result.model.noise.range = 0.15;
    result.model.noise.bearing = 0.01;
  }
  result.comment = "a truck with steering and GPS, " + prefix.string();
  result.figures = {
      counted("rows", recording.drive.rows(), "drive rows, of one wheel and the steering"),
      counted("fixes", recording.fixes.size(), "fixes"),
      counted("repeated_fixes", repeated_fixes,
              "fixes whose time repeats or runs backwards dropped"),
      counted("graph_poses", graph_poses, "poses of victoriaPark.txt found in the drive"),
      counted("sightings", recording.sightings.size(), "sightings of trees from there")};
  return result;
}

}  // namespace trussmap::datasets
