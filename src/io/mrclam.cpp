// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/io/mrclam.hpp"

#include "trussmap/core/error.hpp"
#include "trussmap/io/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr double kWheelbase = 0.258;  // m, iRobot Create, the maker's figure
constexpr double kFrame = 0.005;      // s
constexpr int kLastRobot = 5;         // subjects up to here are robots

using Row = std::vector<double>;

fs::path with_xz(const fs::path& path) {
  fs::path compressed = path;
  compressed += ".xz";
  return compressed;
}

/// The file, plain or compressed; empty if there is neither.
fs::path found(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) return path;
  if (fs::exists(with_xz(path), ignored)) return with_xz(path);
  return {};
}

fs::path beside(const fs::path& prefix, const char* ending) {
  fs::path path = prefix;
  path += ending;
  return path;
}

/// Rows of `columns` numbers, separated by white space; lines that begin with # are skipped.
std::vector<Row> read_rows(const fs::path& file, std::size_t columns) {
  const std::string text = read_file(file);
  std::vector<Row> rows;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++line;
    Row row;
    for (std::size_t k = content.find_first_not_of(" \t\r");
         k != std::string_view::npos && content[k] != '#';) {
      const std::size_t stop = std::min(content.find_first_of(" \t\r", k), content.size());
      const std::string_view word = content.substr(k, stop - k);
      double value = 0.0;
      const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (status != std::errc() || rest != word.data() + word.size() || !std::isfinite(value)) {
        throw InputError(file.string(), line,
                         "\"" + std::string(word) + "\", expected a finite number");
      }
      row.push_back(value);
      k = content.find_first_not_of(" \t\r", stop);
    }
    if (row.empty()) continue;
    if (row.size() != columns) {
      throw InputError(
          file.string(), line,
          std::to_string(row.size()) + " numbers, expected " + std::to_string(columns));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file.string(), 0, "no rows, expected some");
  return rows;
}

std::vector<Row> require_rows(const fs::path& path, std::size_t columns) {
  const fs::path file = found(path);
  if (file.empty()) throw InputError(path.string(), 0, "is missing, plain or as .xz");
  return read_rows(file, columns);
}

/// A subject or barcode; what is no small whole number belongs to nothing.
int number_of(double value) {
  constexpr double kLargest = 1e6;
  return std::abs(value) <= kLargest && value == std::floor(value) ? static_cast<int>(value) : -1;
}

/// Milliseconds survive: the files' times have three decimals.
double since(double epoch, double time) {
  return std::round((time - epoch) * 1e6) / 1e6;
}

void read_drive(const fs::path& prefix, MrclamRecording& result) {
  const std::vector<Row> rows = require_rows(beside(prefix, "_Odometry.dat"), 3);
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
      drive.left.push_back((v - 0.5 * kWheelbase * w) * dt);
      drive.right.push_back((v + 0.5 * kWheelbase * w) * dt);
      before = t;
    } else {
      ++result.merged_times;
    }
    v = rows[k][1];
    w = rows[k][2];
  }
  if (drive.rows() < 2) {
    throw InputError(beside(prefix, "_Odometry.dat").string(), 0,
                     "fewer than three times, expected a drive");
  }
}

void read_sightings(const fs::path& prefix, MrclamRecording& result) {
  std::map<int, int> subjects;
  for (const Row& row : require_rows(prefix.parent_path() / "Barcodes.dat", 2)) {
    subjects[number_of(row[1])] = number_of(row[0]);
  }
  const fs::path file = found(beside(prefix, "_Measurement.dat"));
  if (file.empty()) {
    throw InputError(beside(prefix, "_Measurement.dat").string(), 0, "is missing, plain or as .xz");
  }
  const Drive& drive = result.recording.drive;
  std::vector<Sighting>& sightings = result.recording.sightings;
  double before = -INFINITY;
  for (const Row& row : read_rows(file, 4)) {
    if (row[2] < 0.0) {
      throw InputError(
          file.string(), 0,
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
  const fs::path file = found(prefix.parent_path() / "Landmark_Groundtruth.dat");
  if (file.empty()) return;
  for (const Row& row : read_rows(file, 5)) {
    const double sd = std::sqrt(0.5 * (row[3] * row[3] + row[4] * row[4]));
    recording.survey.push_back(
        {std::to_string(static_cast<int>(row[0])), row[1], row[2], sd > 0.0 ? sd : kAbsent});
  }
}

/// Truth rows within the drive. Times that do not increase are left out.
void read_truth(const fs::path& prefix, MrclamRecording& result) {
  fs::path file = found(beside(prefix, "_Groundtruth.dat"));
  if (file.empty()) file = found(beside(prefix, "_Groundtruth_part.dat"));
  if (file.empty()) return;
  const Drive& drive = result.recording.drive;
  std::vector<TruthRow>& truth = result.recording.truth;
  for (const Row& row : read_rows(file, 4)) {
    const double t = since(result.epoch, row[0]);
    if (t < drive.start() || t > drive.t.back()) continue;
    if (!truth.empty() && t <= truth.back().t) continue;
    truth.push_back({t, row[1], row[2], row[3]});
  }
}

/// These robots have no encoders in the data but commanded velocities: most of the noise is in how
/// far they turned, and the sightings come 0.2-0.3 s late, which while turning is a bearing error.
Model create_model() {
  Model model;
  model.robot.wheelbase = kWheelbase;
  model.noise.left = model.noise.right = 0.02;
  model.noise.heading_per_rad = 0.1;
  model.noise.range = 0.1;
  model.noise.range_relative = 0.05;
  model.noise.bearing = 0.1;
  return model;
}

}  // namespace

bool is_mrclam(const fs::path& prefix) {
  return !found(beside(prefix, "_Odometry.dat")).empty();
}

MrclamRecording read_mrclam(const fs::path& prefix) {
  MrclamRecording result;
  result.recording.name = prefix.string();
  result.model = create_model();
  read_drive(prefix, result);
  read_sightings(prefix, result);
  read_survey(prefix, result.recording);
  read_truth(prefix, result);
  return result;
}

}  // namespace trussmap
