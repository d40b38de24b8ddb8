// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "trussmap/test_path.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace trussmap {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// One segment or several; none where the text is not understood.
TestPath parse_segment(std::string_view text) {
  constexpr std::string_view kEight = "eight@";
  if (text.starts_with(kEight)) {
    const std::optional<double> radius = number(text.substr(kEight.size()));
    return radius && *radius > 0.0 ? figure_eight_path(*radius) : TestPath();
  }
  if (text.starts_with('a')) {
    const std::optional<double> turn = number(text.substr(1));
    if (!turn) return {};
    return {{0.0, *turn * geometry::kDegree}};
  }
  const std::size_t at = text.find('@');
  const std::optional<double> distance = number(text.substr(0, at));
  if (!distance) return {};
  if (at == std::string_view::npos) return {{*distance, 0.0}};
  const std::optional<double> turn = number(text.substr(at + 1));
  if (!turn) return {};
  return {{*distance, *turn * geometry::kDegree}};
}

[[noreturn]] void refuse(const std::string& segment, const std::string& path) {
  throw std::invalid_argument("segment \"" + segment + "\" of the path \"" + path +
                              "\" cannot be read, expected metres (10 or -10), a turn on the spot "
                              "in degrees (a90), an arc (3@45) or a figure-eight (eight@1)");
}

}  // namespace

TestPath parse_path(const std::string& text) {
  TestPath path;
  bool moves = false;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string segment(trimmed(std::string_view(text).substr(begin, comma - begin)));
    const TestPath parsed = parse_segment(segment);
    if (parsed.empty()) refuse(segment, text);
    path.insert(path.end(), parsed.begin(), parsed.end());
    moves = moves || std::any_of(parsed.begin(), parsed.end(), [](const PathSegment& one) {
              return one.distance != 0.0 || one.turn != 0.0;
            });
    begin = comma + 1;
  }
  if (!moves) {
    throw std::invalid_argument("the path \"" + text +
                                "\" does not move, expected a distance or "
                                "a turn other than 0");
  }
  return path;
}

}  // namespace trussmap
