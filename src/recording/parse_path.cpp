// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/test_path.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace trussmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

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

std::optional<PathSegment> parse_segment(std::string_view text) {
  if (text.starts_with('a')) {
    const std::optional<double> turn = number(text.substr(1));
    if (!turn) return std::nullopt;
    return PathSegment{0.0, *turn * kDegree};
  }
  const std::size_t at = text.find('@');
  const std::optional<double> distance = number(text.substr(0, at));
  if (!distance) return std::nullopt;
  if (at == std::string_view::npos) return PathSegment{*distance, 0.0};
  const std::optional<double> turn = number(text.substr(at + 1));
  if (!turn) return std::nullopt;
  return PathSegment{*distance, *turn * kDegree};
}

[[noreturn]] void refuse(const std::string& segment, const std::string& path) {
  throw std::invalid_argument("segment \"" + segment + "\" of the path \"" + path +
                              "\" cannot be read, expected metres (10 or -10), a turn on the spot "
                              "in degrees (a90) or an arc (3@45)");
}

}  // namespace

TestPath parse_path(const std::string& text) {
  TestPath path;
  bool moves = false;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string segment(trimmed(std::string_view(text).substr(begin, comma - begin)));
    const std::optional<PathSegment> parsed = parse_segment(segment);
    if (!parsed) refuse(segment, text);
    path.push_back(*parsed);
    moves = moves || parsed->distance != 0.0 || parsed->turn != 0.0;
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
