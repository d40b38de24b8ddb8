// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Ranges to radio beacons along a drive (Djugash, Hamner & Roth, 2009; "Plaza1") as a recording.
//
//   PREFIX_DR.txt   time [s], distance [m] and turn [rad] since the row before
//   PREFIX_TD.txt   time [s], antenna, beacon, range [m]
//   PREFIX_GT.csv   time [s], x, y [m], heading [rad]; may be absent
//
// Plain or .xz. Of the wheels nothing is stated: they are those of a robot with a wheelbase of 1 m
// that drives and turns so. Ranges are sorted by time, those outside of the drive are dropped.
#include "datasets/formats.hpp"
#include "datasets/nominal_wheelbase.hpp"
#include "datasets/number_rows.hpp"
#include "io/csv.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

struct RangeRecording {
  Recording recording;

  double epoch = 0.0;        ///< s, time of t = 0
  int outside_drive = 0;     ///< ranges before or after the odometry, dropped
  int unordered_ranges = 0;  ///< ranges earlier than the one before, sorted in
};

/// Noise that suits such radios.
Model radio_model() {
  Model model;
  model.robot.wheelbase = kNominalWheelbase;
  model.noise.left = model.noise.right = 0.02;
  model.noise.range = 0.5;
  model.noise.heading_per_s = 0.002;
  model.noise.truth = 0.02;
  return model;
}

/// A table of the data set, plain or compressed.
struct Table {
  Table(const fs::path& path, std::size_t columns)
      : file(require_plain_or_xz(path).string()), rows(read_number_rows(file, columns, kCommas)) {}

  std::string file;
  std::vector<NumberRow> rows;
};

void read_drive(const fs::path& prefix, RangeRecording& result) {
  const Table table(beside(prefix, "_DR.txt"), 3);
  const NumberRow& first = table.rows.front();
  io::SourceLine(table.file, first.line).expect("time", first[0], io::kLargestTime);
  result.epoch = std::floor(first[0]);
  Drive& drive = result.recording.drive;
  for (const NumberRow& row : table.rows) {
    const double t = since(result.epoch, row[0]);
    if (!drive.t.empty() && t <= drive.t.back()) {
      throw InputError(table.file, row.line,
                       "time repeats or runs backwards at " + io::csv_number(row[0]));
    }
    drive.t.push_back(t);
    drive.left.push_back(row[1] - 0.5 * kNominalWheelbase * row[2]);
    drive.right.push_back(row[1] + 0.5 * kNominalWheelbase * row[2]);
    io::SourceLine(table.file, row.line).expect_last_row(drive);
  }
  if (drive.rows() < 2) {
    throw InputError(table.file, 0, "one row, expected two at least");
  }
}

void read_ranges(const fs::path& prefix, RangeRecording& result) {
  const Table table(beside(prefix, "_TD.txt"), 4);
  const Drive& drive = result.recording.drive;
  std::vector<Sighting>& sightings = result.recording.sightings;
  for (const NumberRow& row : table.rows) {
    constexpr double kLargestId = 1e6;
    if (!(row[2] >= 0.0) || row[2] > kLargestId || row[2] != std::floor(row[2])) {
      throw InputError(table.file, row.line,
                       "beacon " + io::csv_number(row[2]) + ", expected a whole number from 0");
    }
    if (row[3] < 0.0) {
      throw InputError(
          table.file, row.line,
          "a negative range at time " + io::csv_number(row[0]) + ", expected 0 or more");
    }
    const double t = since(result.epoch, row[0]);
    if (t < drive.start() || t > drive.t.back()) {
      ++result.outside_drive;
      continue;
    }
    if (!sightings.empty() && t < sightings.back().t) ++result.unordered_ranges;
    sightings.push_back({t, std::to_string(static_cast<int>(row[2])), row[3], kAbsent});
    io::SourceLine(table.file, row.line).expect(sightings.back());
  }
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  if (sightings.empty()) throw InputError(table.file, 0, "no range lies within the drive");
}

void read_truth(const fs::path& prefix, RangeRecording& result) {
  if (plain_or_xz(beside(prefix, "_GT.csv")).empty()) return;
  const Drive& drive = result.recording.drive;
  const Table table(beside(prefix, "_GT.csv"), 4);
  for (const NumberRow& row : table.rows) {
    const double t = since(result.epoch, row[0]);
    const bool later = result.recording.truth.empty() || t > result.recording.truth.back().t;
    if (t < drive.start() || t > drive.t.back() || !later) continue;
    result.recording.truth.push_back({t, row[1], row[2], row[3]});
    io::SourceLine(table.file, row.line).expect(result.recording.truth.back());
  }
}

}  // namespace

bool is_radio_ranges(const fs::path& prefix) {
  return !plain_or_xz(beside(prefix, "_DR.txt")).empty() ||
         !plain_or_xz(beside(prefix, "_TD.txt")).empty();
}

Dataset read_radio_ranges(const fs::path& prefix) {
  RangeRecording read;
  read.recording.name = prefix.string();
  read_drive(prefix, read);
  read_ranges(prefix, read);
  read_truth(prefix, read);
  std::vector<DatasetFigure> figures{
      counted("rows", read.recording.drive.rows(), "drive rows, as of a wheelbase of 1 m"),
      counted("ranges", read.recording.sightings.size(), "ranges"),
      counted("truth", read.recording.truth.size(), "truth rows"),
      counted("outside_drive", read.outside_drive, "ranges outside of the drive dropped"),
      counted("unordered_ranges", read.unordered_ranges, "ranges were out of order in time")};
  return {std::move(read.recording), radio_model(), read.epoch,
          fmt::format("t = 0 is {:.0f} s", read.epoch), std::move(figures)};
}

}  // namespace trussmap::datasets
