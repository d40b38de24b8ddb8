// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives with places that look alike (TUC SLAM: Neubert, Schubert & Protzel, 2019) as recordings.
//
//   PREFIX_Input.txt   odom2 time [s], velocity ahead and to the left [m/s], turn rate [rad/s],
//                      three variances; loop time, time [s], similarity
//
// Plain or .xz. A velocity holds from its row's time until the next row's; what is to the left is
// the motion of a point off the axle, and passed over. A loop says that the robot is at the same
// pose, to what its model says; many are wrong. Of wheels nothing is stated, as above.
#include "datasets/formats.hpp"
#include "datasets/nominal_wheelbase.hpp"
#include "datasets/number_rows.hpp"
#include "io/csv.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

struct TaggedRow {
  std::string_view tag;
  std::vector<double> numbers;
  std::size_t line = 0;
};

/// A word, then numbers.
std::vector<TaggedRow> tagged_rows(std::string_view text, const std::string& file) {
  std::vector<TaggedRow> rows;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = text.substr(at, end - at);
    at = end + 1;
    ++line;
    TaggedRow row;
    row.line = line;
    for (std::size_t k = content.find_first_not_of(kWhiteSpace); k != std::string_view::npos;) {
      const std::size_t stop = std::min(content.find_first_of(kWhiteSpace, k), content.size());
      const std::string_view word = content.substr(k, stop - k);
      k = content.find_first_not_of(kWhiteSpace, stop);
      if (row.tag.empty()) {
        row.tag = word;
        continue;
      }
      double value = 0.0;
      const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (status != std::errc() || rest != word.data() + word.size() || !std::isfinite(value)) {
        throw InputError(file, line, io::shown_field(word) + ", expected a finite number");
      }
      row.numbers.push_back(value);
    }
    if (!row.tag.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

void require_numbers(const TaggedRow& row, std::size_t count, const std::string& file) {
  if (row.numbers.size() == count) return;
  throw InputError(file, row.line,
                   std::to_string(row.numbers.size()) + " numbers after " + std::string(row.tag) +
                       ", expected " + std::to_string(count));
}

/// A velocity holds from its row's time until the next row's.
void add_velocity(const TaggedRow& row, const std::string& file, TaggedRow& before, Drive& drive) {
  if (!before.numbers.empty()) {
    const double t = row.numbers[0];
    const double duration = t - before.numbers[0];
    if (!(duration > 0.0)) {
      throw InputError(file, row.line, "time repeats or runs backwards at " + io::csv_number(t));
    }
    const double path = duration * before.numbers[1];
    const double apart = 0.5 * kNominalWheelbase * duration * before.numbers[3];
    drive.t.push_back(t);
    drive.left.push_back(path - apart);
    drive.right.push_back(path + apart);
    io::SourceLine(file, row.line).expect_last_row(drive);
  }
  before = row;
}

}  // namespace

bool is_place_loops(const fs::path& prefix) {
  return !plain_or_xz(beside(prefix, "_Input.txt")).empty();
}

Dataset read_place_loops(const fs::path& prefix) {
  const fs::path file = require_plain_or_xz(beside(prefix, "_Input.txt"));
  const std::string text = read_file(file);
  Dataset result;
  result.recording.name = prefix.string();
  Drive& drive = result.recording.drive;
  std::vector<Loop> loops;
  int outside_drive = 0;
  TaggedRow before;
  for (const TaggedRow& row : tagged_rows(text, file.string())) {
    if (row.tag == "odom2") {
      require_numbers(row, 7, file.string());
      add_velocity(row, file.string(), before, drive);
    } else if (row.tag == "loop") {
      require_numbers(row, 3, file.string());
      loops.push_back({row.numbers[0], row.numbers[1], 0.0, 0.0, 0.0});
    } else {
      throw InputError(file.string(), row.line,
                       io::shown_field(row.tag) + ", expected odom2 or loop");
    }
  }
  if (drive.rows() < 2) throw InputError(file.string(), 0, "no drive, expected rows of odom2");
  for (const Loop& loop : loops) {
    const auto inside = [&drive](double t) { return t >= drive.start() && t <= drive.t.back(); };
    if (inside(loop.t) && inside(loop.t2) && loop.t != loop.t2) {
      result.recording.loops.push_back(loop);
    } else {
      ++outside_drive;
    }
  }
  if (result.recording.loops.empty()) {
    throw InputError(file.string(), 0, "no loop lies within the drive");
  }
  result.model.robot.wheelbase = kNominalWheelbase;
  result.model.noise.left = result.model.noise.right = 0.02;
  result.model.noise.heading_per_s = 0.003;
  // What looks alike lies within a metre, and is looked at from about the same side.
  result.model.noise.loop = 1.0;
  result.model.noise.loop_heading = 0.5;
  result.comment = "places that look alike, " + prefix.string();
  result.figures = {counted("rows", drive.rows(), "drive rows, as of a wheelbase of 1 m"),
                    counted("loops", result.recording.loops.size(), "loops"),
                    counted("outside_drive", outside_drive, "loops outside of the drive dropped")};
  return result;
}

}  // namespace trussmap::datasets
