// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/mat_columns.hpp"
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

constexpr double kAxles = 2.83;       // m, rear to front
constexpr double kWheelLeft = 0.76;   // m, of the wheel with the encoder
constexpr double kMostNumber = 1e12;  // ms, m: beyond all that is meant

fs::path drive_file(const fs::path& prefix) {
  return prefix.string() + "_dr.mat";
}

fs::path fixes_file(const fs::path& prefix) {
  return prefix.string() + "_gpsx.mat";
}

const std::vector<double>& column(const Columns& columns, const char* name, const fs::path& file,
                                  std::size_t rows = 0) {
  const auto found = columns.find(name);
  if (found == columns.end()) {
    throw InputError(file.string(), 0, std::string("has no \"") + name + "\", expected it");
  }
  const std::vector<double>& values = found->second;
  if (rows > 0 && values.size() != rows) {
    throw InputError(file.string(), 0,
                     std::string("\"") + name + "\" has " + std::to_string(values.size()) +
                         " numbers, expected " + std::to_string(rows) + " as the times are");
  }
  for (const double one : values) {
    if (std::abs(one) <= kMostNumber) continue;
    throw InputError(file.string(), 0,
                     std::string("\"") + name + "\" holds no number, or one beyond 1e12");
  }
  return values;
}

}  // namespace

bool is_steered_truck(const fs::path& prefix) {
  return fs::exists(drive_file(prefix)) || fs::exists(fixes_file(prefix));
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
  const std::vector<double>& time = column(drive, "time", driven);
  const std::vector<double>& speed = column(drive, "speed", driven, time.size());
  const std::vector<double>& steering = column(drive, "steering", driven, time.size());
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
  }
  if (recording.drive.rows() < 2) {
    throw InputError(driven.string(), 0, "has fewer than three rows, expected a drive");
  }
  const fs::path received = fixes_file(prefix);
  const Columns fixes = read_mat_columns(received);
  const std::vector<double>& stamped = column(fixes, "timeGps", received);
  const std::vector<double>& east = column(fixes, "Lo_m", received, stamped.size());
  const std::vector<double>& north = column(fixes, "La_m", received, stamped.size());
  for (std::size_t k = 0; k < stamped.size(); ++k) {
    if (k > 0 && !(stamped[k] > stamped[k - 1])) {
      ++result.repeated_fixes;
      continue;
    }
    recording.fixes.push_back({1e-3 * (stamped[k] - time[0]), east[k], north[k]});
  }
  return result;
}

}  // namespace trussmap
