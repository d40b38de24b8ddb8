// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The UTIAS multi-robot data sets (MRCLAM: Leung, Halpern, Barfoot & Liu, 2011) as recordings.
//
//   DIR/RobotN_Odometry.dat      time, forward velocity [m/s], angular velocity [rad/s]
//   DIR/RobotN_Measurement.dat   time, barcode, range [m], bearing [rad]
//   DIR/Barcodes.dat             subject, barcode: subjects 1-5 are robots, the rest landmarks
//   DIR/Landmark_Groundtruth.dat subject, x, y, sd of x, sd of y       (optional)
//   DIR/RobotN_Groundtruth.dat   time, x, y, heading                   (optional)
//
// each plain or with .xz. A velocity holds from its row's time until the next row's. Times that
// repeat or run backwards are merged into the row before; sightings of robots, of unknown barcodes
// and outside of the drive are dropped; sightings within 5 ms of one another are one camera frame
// and get its first time. All of that is counted. Times are counted from the epoch, a whole second.
#include "datasets/formats.hpp"
#include "datasets/number_rows.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kCreateWheelbase = 0.258;  // m, iRobot Create, the maker's figure
constexpr double kFrame = 0.005;            // s
constexpr int kLastRobot = 5;               // subjects up to here are robots

struct MrclamRecording {
  Recording recording;

  double epoch = 0.0;           ///< s, Unix time of t = 0
  int merged_times = 0;         ///< odometry rows whose time repeats or runs backwards
  int robots_seen = 0;          ///< sightings of other robots, dropped
  int unknown_barcodes = 0;     ///< sightings of barcodes that belong to nothing, dropped
  int outside_drive = 0;        ///< sightings before or after the odometry, dropped
  int same_frame = 0;           ///< sightings whose time was set to their frame's
  int unordered_sightings = 0;  ///< sightings earlier than the one before, sorted in
};

std::vector<NumberRow> read_rows(const fs::path& file, std::size_t columns) {
  return read_number_rows(file, columns, kWhiteSpace);
}

std::vector<NumberRow> require_rows(const fs::path& path, std::size_t columns) {
  return read_rows(require_plain_or_xz(path), columns);
}

/// A subject or barcode; what is no small whole number belongs to nothing.
int number_of(double value) {
  constexpr double kLargest = 1e6;
  return std::abs(value) <= kLargest && value == std::floor(value) ? static_cast<int>(value) : -1;
}

void read_drive(const fs::path& prefix, MrclamRecording& result) {
  const fs::path file = require_plain_or_xz(beside(prefix, "_Odometry.dat"));
  const std::string name = file.string();
  const std::vector<NumberRow> rows = read_rows(file, 3);
  io::SourceLine(name, rows.front().line).expect("time", rows.front()[0], io::kLargestTime);
  result.epoch = std::floor(rows.front()[0]);
  Drive& drive = result.recording.drive;
  double before = since(result.epoch, rows.front()[0]);
  double v = rows.front()[1];
  double w = rows.front()[2];
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double t = since(result.epoch, rows[k][0]);
    if (t > before) {
      const double dt = t - before;
      drive.t.push_back(t);
      drive.left.push_back((v - 0.5 * kCreateWheelbase * w) * dt);
      drive.right.push_back((v + 0.5 * kCreateWheelbase * w) * dt);
      io::SourceLine(name, rows[k].line).expect_last_row(drive);
      before = t;
    } else {
      ++result.merged_times;
    }
    v = rows[k][1];
    w = rows[k][2];
  }
  if (drive.rows() < 2) {
    throw InputError(name, 0, "fewer than three times, expected a drive");
  }
}

void read_sightings(const fs::path& prefix, MrclamRecording& result) {
  std::map<int, int> subjects;
  for (const NumberRow& row : require_rows(prefix.parent_path() / "Barcodes.dat", 2)) {
    subjects[number_of(row[1])] = number_of(row[0]);
  }
  const fs::path file = require_plain_or_xz(beside(prefix, "_Measurement.dat"));
  const std::string name = file.string();
  const Drive& drive = result.recording.drive;
  std::vector<Sighting>& sightings = result.recording.sightings;
  double before = -std::numeric_limits<double>::infinity();
  for (const NumberRow& row : read_rows(file, 4)) {
    if (row[2] < 0.0) {
      throw InputError(
          name, row.line,
          "a negative range at time " + std::to_string(row[0]) + ", expected 0 or more");
    }
    if (row[0] < before) ++result.unordered_sightings;
    before = std::max(before, row[0]);
    const double t = since(result.epoch, row[0]);
    const auto subject = subjects.find(number_of(row[1]));
    if (subject == subjects.end()) {
      ++result.unknown_barcodes;
    } else if (subject->second <= kLastRobot) {
      ++result.robots_seen;
    } else if (t < drive.start() || t > drive.t.back()) {
      ++result.outside_drive;
    } else {
      sightings.push_back({t, std::to_string(subject->second), row[2], row[3]});
      io::SourceLine(name, row.line).expect(sightings.back());
    }
  }
  if (sightings.empty()) {
    throw InputError(file.string(), 0, "no sighting of a landmark within the drive, expected some");
  }
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  for (std::size_t k = 1; k < sightings.size(); ++k) {
    const double gap = sightings[k].t - sightings[k - 1].t;
    if (gap > 0.0 && gap <= kFrame) {
      sightings[k].t = sightings[k - 1].t;
      ++result.same_frame;
    }
  }
}

void read_survey(const fs::path& prefix, Recording& recording) {
  const fs::path file = plain_or_xz(prefix.parent_path() / "Landmark_Groundtruth.dat");
  if (file.empty()) return;
  const std::string name = file.string();
  std::set<int> subjects;
  for (const NumberRow& row : read_rows(file, 5)) {
    const int subject = number_of(row[0]);
    if (subject < 0) continue;
    if (!subjects.insert(subject).second) {
      throw InputError(
          name, row.line,
          "subject " + std::to_string(subject) + " is surveyed twice, expected each once");
    }
    const double sd = std::sqrt(0.5 * (row[3] * row[3] + row[4] * row[4]));
    recording.survey.push_back({std::to_string(subject), row[1], row[2], sd > 0.0 ? sd : kAbsent});
    io::SourceLine(name, row.line).expect(recording.survey.back());
  }
}

/// Truth rows within the drive. Times that do not increase are left out.
void read_truth(const fs::path& prefix, MrclamRecording& result) {
  fs::path file = plain_or_xz(beside(prefix, "_Groundtruth.dat"));
  if (file.empty()) file = plain_or_xz(beside(prefix, "_Groundtruth_part.dat"));
  if (file.empty()) return;
  const Drive& drive = result.recording.drive;
  std::vector<TruthRow>& truth = result.recording.truth;
  const std::string name = file.string();
  for (const NumberRow& row : read_rows(file, 4)) {
    const double t = since(result.epoch, row[0]);
    if (t < drive.start() || t > drive.t.back()) continue;
    if (!truth.empty() && t <= truth.back().t) continue;
    truth.push_back({t, row[1], row[2], row[3]});
    io::SourceLine(name, row.line).expect(truth.back());
  }
}

/// These robots have no encoders in the data but commanded velocities, which they reach or not:
/// noise in how far they drove goes with time, in how far they turned with the turn. All values
/// are the same for the five robots of sets 6, 1 and 4. Drive: chi^2 is 0.9 (forward) and 1.0
/// (turn) of what is redundant, with one camera frame in 3 s. Sightings: their chi^2 is 0.7 (range)
/// and 0.3 (bearing); they get a larger sd because at 4 frames per second errors last for seconds,
/// and because the frames come 0.25 s late, which while turning is a bearing error.
Model create_model() {
  Model model;
  model.robot.wheelbase = kCreateWheelbase;
  model.noise.left = model.noise.right = 0.02;
  model.noise.heading_per_rad = 0.1;
  model.noise.travel_per_s = 0.02;
  model.noise.range = 0.05;
  model.noise.range_relative = 0.05;
  model.noise.bearing = 0.03;
  return model;
}

}  // namespace

bool is_mrclam(const fs::path& prefix) {
  // One without odometry is a robot of such a set as well: reading it says what is missing.
  for (const char* ending : {"_Odometry.dat", "_Measurement.dat", "_Groundtruth.dat"}) {
    if (!plain_or_xz(beside(prefix, ending)).empty()) return true;
  }
  return prefix.filename().string().starts_with("Robot") &&
         !plain_or_xz(prefix.parent_path() / "Barcodes.dat").empty();
}

Dataset read_mrclam(const fs::path& prefix) {
  MrclamRecording read;
  read.recording.name = prefix.string();
  read_drive(prefix, read);
  read_sightings(prefix, read);
  read_survey(prefix, read.recording);
  read_truth(prefix, read);
  std::vector<DatasetFigure> figures{
      counted("rows", read.recording.drive.rows(), "drive rows"),
      counted("sightings", read.recording.sightings.size(), "sightings"),
      counted("survey", read.recording.survey.size(), "surveyed landmarks"),
      counted("truth", read.recording.truth.size(), "truth rows"),
      counted("merged_times", read.merged_times,
              "odometry rows merged: their time repeats or runs backwards"),
      counted("robots_seen", read.robots_seen, "sightings of other robots dropped"),
      counted("unknown_barcodes", read.unknown_barcodes, "sightings of unknown barcodes dropped"),
      counted("outside_drive", read.outside_drive, "sightings outside of the drive dropped"),
      counted("unordered_sightings", read.unordered_sightings,
              "sightings were out of order in time"),
      counted("same_frame", read.same_frame,
              "sightings set to the time of their camera frame (within 5 ms)")};
  return {std::move(read.recording), create_model(), read.epoch,
          fmt::format("t = 0 is {:.0f} s, Unix time", read.epoch), std::move(figures)};
}

}  // namespace trussmap::datasets
