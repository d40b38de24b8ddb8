// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/present.hpp"
#include "io/mat_columns.hpp"
#include "io/number_rows.hpp"
#include "io/recording_limits.hpp"
#include "io/truck_trees.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace trussmap {
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
  return is_present(drive_file(prefix)) || is_present(fixes_file(prefix));
}

TruckRecording read_steered_truck(const fs::path& prefix) {
  TruckRecording result;
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
    SourceLine(driven.string() + ", row " + std::to_string(k + 1), 0)
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
      ++result.repeated_fixes;
      continue;
    }
    recording.fixes.push_back({1e-3 * (stamped[k] - time[0]), east[k], north[k]});
    SourceLine(received.string() + ", row " + std::to_string(k + 1), 0)
        .expect(recording.fixes.back());
  }
  const fs::path graph = graph_file(prefix);
  if (!graph.empty()) {
    result.graph_poses = take_trees(graph, steps_of(recording.drive), recording);
    result.model.noise.range = 0.15;
    result.model.noise.bearing = 0.01;
  }
  return result;
}

}  // namespace trussmap
