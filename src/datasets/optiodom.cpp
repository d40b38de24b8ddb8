// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// OptiOdom runs (Sousa, Petry, Costa & Moreira, 2022) as recordings.
//
//   SET_run-NN.csv   time [s], x, y [m], heading [rad], and of the cycle that ends then
//                      diff     ticks of the right wheel, of the left wheel
//                      tricyc   ticks of the steered wheel, its angle [rad]
//                      omni3    ticks of the three wheels
//                    no header; plain or .xz
//   SET_metadata.csv beside it: type, ngear, encRes (counts per turn of the motor), ...
//
// Nominal: wheels of 0.084 m and a wheelbase of 0.20 m; a wheel of 0.065 m, 0.15 m before the rear
// axle; wheels of 0.102 m, 0.195 m from the centre. With other wheels than two the drive's columns
// are covariates, and the model names them. (The metadata's own Li and Di are
// what the controller believed during the set.) There are no landmarks: truth.csv takes their
// place.
#include "datasets/formats.hpp"
#include "datasets/number_rows.hpp"
#include "io/csv_record.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

/// Nominal; what the metadata say are a controller's parameters of the day.
struct OptiOdomRobot {
  const char* type;  ///< of the metadata
  DriveKind drive;
  double wheel_diameter;             ///< m
  double size;                       ///< m: wheelbase, length, or centre to wheel
  std::vector<std::string> columns;  ///< after t, x, y, heading; one that steers holds angles
};

const OptiOdomRobot* robot_of(const std::string& type) {
  static const std::vector<OptiOdomRobot> robots{
      {"diff", DriveKind::differential, 0.084, 0.20, {"right", "left"}},
      {"tricyc", DriveKind::tricycle, 0.065, 0.15, {"wheel", "steer"}},
      {"omni3", DriveKind::omni3, 0.102, 0.195, {"wheel1", "wheel2", "wheel3"}}};
  const auto found = std::find_if(robots.begin(), robots.end(),
                                  [&type](const OptiOdomRobot& one) { return one.type == type; });
  return found == robots.end() ? nullptr : &*found;
}

/// The run's name without its endings, "SET_run-NN"; empty if it is none.
std::string run_of(const fs::path& file) {
  std::string name = file.filename().string();
  if (name.ends_with(".xz")) name.resize(name.size() - 3);
  if (!name.ends_with(".csv")) return {};
  name.resize(name.size() - 4);
  const std::size_t at = name.rfind("_run-");
  const bool numbered = at != std::string::npos && name.size() > at + 5 &&
                        name.find_first_not_of("0123456789", at + 5) == std::string::npos;
  return numbered ? name : std::string();
}

/// First value of each key.
std::map<std::string, std::string> read_metadata(const fs::path& file) {
  if (plain_or_xz(file).empty()) {
    throw InputError(file.string(), 0, "is missing, expected the set's metadata beside the run");
  }
  std::map<std::string, std::string> values;
  std::istringstream lines(read_file(plain_or_xz(file)));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos) continue;
    const std::size_t end = line.find_first_of(",\r", comma + 1);
    values[line.substr(0, comma)] = line.substr(comma + 1, end - comma - 1);
  }
  return values;
}

double positive_number(const std::map<std::string, std::string>& metadata, const char* key,
                       const fs::path& file) {
  const auto found = metadata.find(key);
  const std::string text = found == metadata.end() ? std::string() : found->second;
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  constexpr double kSmallest = 1e-3;  // a gear's ratio, counts per turn
  constexpr double kLargest = 1e9;
  if (status != std::errc() || end != text.data() + text.size() || !(value >= kSmallest) ||
      !(value <= kLargest)) {
    throw InputError(file.string(), 0,
                     std::string(key) + " is " + io::shown_field(text) +
                         ", expected a positive number, from 0.001 to 1e9");
  }
  return value;
}

/// As the next row of the drive.
void take_row(const NumberRow& row, const OptiOdomRobot& robot, double metre_per_tick,
              Drive& drive) {
  drive.t.push_back(row[0]);
  if (robot.drive == DriveKind::differential) {
    drive.right.push_back(row[4] * metre_per_tick);
    drive.left.push_back(row[5] * metre_per_tick);
    return;
  }
  for (std::size_t k = 0; k < robot.columns.size(); ++k) {
    const bool steers = robot.columns[k] == "steer";
    drive.covariates[k].values.push_back(steers ? row[4 + k] : row[4 + k] * metre_per_tick);
  }
}

/// Encoders of 0.1 mm a tick, a motion capture of about a millimetre; the wheels' noise is that of
/// the best runs, to start from: calibrate finds its own.
Model nominal_model(const OptiOdomRobot& robot) {
  Model model;
  model.robot.drive = robot.drive;
  if (robot.drive == DriveKind::differential) {
    model.robot.wheelbase = robot.size;
  } else {
    model.robot.length = robot.size;
    model.robot.columns = robot.columns;
  }
  model.noise.left = model.noise.right = 0.002;
  model.noise.truth = 0.001;
  model.noise.truth_heading = 0.005;
  return model;
}

}  // namespace

bool is_optiodom(const fs::path& file) {
  return !run_of(file).empty();
}

Dataset read_optiodom(const fs::path& file) {
  const std::string run = run_of(file);
  if (run.empty()) throw InputError(file.string(), 0, "is no run, expected ..._run-NN.csv[.xz]");
  const fs::path about = file.parent_path() / (run.substr(0, run.rfind("_run-")) + "_metadata.csv");
  const auto metadata = read_metadata(about);
  const auto type = metadata.find("type");
  const OptiOdomRobot* robot = type == metadata.end() ? nullptr : robot_of(type->second);
  if (robot == nullptr) {
    throw InputError(about.string(), 0,
                     "the robot's type is " +
                         io::shown_field(type == metadata.end() ? "" : type->second) +
                         ", expected diff, tricyc or omni3");
  }
  Dataset result;
  result.model = nominal_model(*robot);
  const double metre_per_tick =
      std::numbers::pi * robot->wheel_diameter /
      (positive_number(metadata, "ngear", about) * positive_number(metadata, "encRes", about));
  Recording& recording = result.recording;
  recording.name = file.string();
  double before = -std::numeric_limits<double>::infinity();
  if (robot->drive != DriveKind::differential) {
    for (const std::string& name : robot->columns) recording.drive.covariates.push_back({name, {}});
  }
  const std::size_t fields = 4 + robot->columns.size();
  const std::string name = file.string();
  for (const NumberRow& row : read_number_rows(file, fields, kCommas)) {
    if (!(row[0] > before)) {
      throw InputError(name, row.line, "time runs backwards, expected rows in order of time");
    }
    before = row[0];
    recording.truth.push_back({row[0], row[1], row[2], wrap_angle(row[3])});
    take_row(row, *robot, metre_per_tick, recording.drive);
    const io::SourceLine source(name, row.line);
    source.expect(recording.truth.back());
    source.expect_last_row(recording.drive);
  }
  if (recording.drive.rows() < 2) {
    throw InputError(file.string(), 0, "fewer than two rows, expected a drive");
  }
  result.comment = "OptiOdom run " + file.filename().string();
  result.figures = {counted("rows", recording.drive.rows(), "drive rows, each with the truth"),
                    {"mm_per_tick", 1000.0 * metre_per_tick, "mm a tick"}};
  return result;
}

}  // namespace trussmap::datasets
