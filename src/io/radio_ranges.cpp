// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/nominal_wheelbase.hpp"
#include "io/number_rows.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

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
  SourceLine(table.file, first.line).expect("time", first[0], kLargestTime);
  result.epoch = std::floor(first[0]);
  Drive& drive = result.recording.drive;
  for (const NumberRow& row : table.rows) {
    const double t = since(result.epoch, row[0]);
    if (!drive.t.empty() && t <= drive.t.back()) {
      throw InputError(table.file, row.line,
                       "time repeats or runs backwards at " + csv_number(row[0]));
    }
    drive.t.push_back(t);
    drive.left.push_back(row[1] - 0.5 * kNominalWheelbase * row[2]);
    drive.right.push_back(row[1] + 0.5 * kNominalWheelbase * row[2]);
    SourceLine(table.file, row.line).expect_last_row(drive);
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
                       "beacon " + csv_number(row[2]) + ", expected a whole number from 0");
    }
    if (row[3] < 0.0) {
      throw InputError(table.file, row.line,
                       "a negative range at time " + csv_number(row[0]) + ", expected 0 or more");
    }
    const double t = since(result.epoch, row[0]);
    if (t < drive.start() || t > drive.t.back()) {
      ++result.outside_drive;
      continue;
    }
    if (!sightings.empty() && t < sightings.back().t) ++result.unordered_ranges;
    sightings.push_back({t, std::to_string(static_cast<int>(row[2])), row[3], kAbsent});
    SourceLine(table.file, row.line).expect(sightings.back());
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
    SourceLine(table.file, row.line).expect(result.recording.truth.back());
  }
}

}  // namespace

bool is_radio_ranges(const fs::path& prefix) {
  return !plain_or_xz(beside(prefix, "_DR.txt")).empty() ||
         !plain_or_xz(beside(prefix, "_TD.txt")).empty();
}

RangeRecording read_radio_ranges(const fs::path& prefix) {
  RangeRecording result;
  result.recording.name = prefix.string();
  read_drive(prefix, result);
  read_ranges(prefix, result);
  read_truth(prefix, result);
  result.model.robot.wheelbase = kNominalWheelbase;
  result.model.noise.left = result.model.noise.right = 0.02;
  result.model.noise.range = 0.5;
  result.model.noise.heading_per_s = 0.002;
  result.model.noise.truth = 0.02;
  return result;
}

}  // namespace trussmap
