// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/phil_frames.hpp"

#include "datasets/number_rows.hpp"
#include "geometry/units.hpp"
#include "io/csv.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kFrameRate = 100.0;   // Hz
constexpr double kTruthStep = 0.1;     // s
constexpr double kFastestBody = 5.0;   // m/s
constexpr double kFastestTurn = 20.0;  // rad/s
// The tracked body's x axis points to the right of the robot's and a little back: by its course
// while it drives straight on, 104.2 to 104.9 deg in three trials.
constexpr double kAheadOfBody = 104.4 * geometry::kDegree;

/// Cells of a line, NaN where one is empty.
std::vector<double> cells(std::string_view content, const std::string& file, std::size_t line) {
  std::vector<double> row;
  for (std::size_t at = 0; at <= content.size();) {
    const std::size_t end = std::min(content.find(',', at), content.size());
    std::string_view word = content.substr(at, end - at);
    at = end + 1;
    while (!word.empty() && kWhiteSpace.find(word.front()) != std::string_view::npos) {
      word.remove_prefix(1);
    }
    while (!word.empty() && kWhiteSpace.find(word.back()) != std::string_view::npos) {
      word.remove_suffix(1);
    }
    double value = kAbsent;
    if (!word.empty()) {
      const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
      constexpr double kLargest = 1e9;  // mm, or frames: beyond any arena
      if (status != std::errc() || rest != word.data() + word.size() ||
          !(std::abs(value) <= kLargest)) {
        throw InputError(file, line,
                         io::shown_field(word) + ", expected a number of size 1e9 at most");
      }
    }
    row.push_back(value);
  }
  return row;
}

/// atan2(R21, R11) of the rotation by the vector's length about it.
double heading_of(double x, double y, double z) {
  const double angle = std::hypot(x, y, z);
  if (!(angle > 0.0)) return 0.0;
  const double c = std::cos(angle);
  const double s = std::sin(angle) / angle;
  const double rest = (1.0 - c) / (angle * angle);
  return std::atan2(s * z + rest * x * y, c + rest * x * x);
}

/// Of a frame: frame, rotation vector [rad], position [mm].
std::optional<TruthRow> pose_of(const std::vector<double>& row, double t) {
  bool zero = true;
  for (std::size_t k = 1; k < row.size(); ++k) {
    if (std::isnan(row[k])) return {};
    zero = zero && row[k] == 0.0;
  }
  if (zero) return {};
  return TruthRow{t, 1e-3 * row[4], 1e-3 * row[5],
                  wrap_angle(heading_of(row[1], row[2], row[3]) + kAheadOfBody)};
}

bool jumps(const TruthRow& from, const TruthRow& to) {
  const double lasts = to.t - from.t;
  return std::hypot(to.x - from.x, to.y - from.y) > kFastestBody * lasts ||
         std::abs(wrap_angle(to.heading - from.heading)) > kFastestTurn * lasts;
}

}  // namespace

std::vector<TruthRow> read_phil_frames(const fs::path& folder, double until, int& lost) {
  const fs::path file = require_plain_or_xz(folder / "mocap_robot.csv");
  const std::string text = read_file(file);
  std::vector<TruthRow> truth;
  std::optional<double> first, frame;
  std::optional<TruthRow> good;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++line;
    const std::size_t begin = content.find_first_not_of(kWhiteSpace);
    if (begin == std::string_view::npos || content[begin] == '#') continue;
    const std::vector<double> row = cells(content, file.string(), line);
    if (row.size() != 7) {
      throw InputError(file.string(), line,
                       std::to_string(row.size()) +
                           " fields, expected 7: frame, rotation "
                           "vector, position");
    }
    if (!(row[0] > frame.value_or(-std::numeric_limits<double>::infinity()))) {
      throw InputError(file.string(), line,
                       "the frame's number is empty or does not grow, expected a larger one");
    }
    frame = row[0];
    if (!first) first = frame;
    const std::optional<TruthRow> pose = pose_of(row, since(*first, *frame) / kFrameRate);
    if (!pose || (good && jumps(*good, *pose))) {
      ++lost;
      continue;
    }
    good = pose;
    if (pose->t > until) continue;
    if (truth.empty() || pose->t - truth.back().t > kTruthStep - 0.5 / kFrameRate) {
      truth.push_back(*pose);
    }
  }
  if (truth.empty()) {
    throw InputError(file.string(), 0, "no frame shows the robot, expected its poses");
  }
  return truth;
}

}  // namespace trussmap::datasets
