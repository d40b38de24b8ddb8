// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/channel_words.hpp"

#include "geometry/units.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::wording {

Scale scale_of(Channel channel) {
  const std::string_view unit = facts_of(channel).unit;
  if (unit == "rad/s") return {geometry::kDegrees * 60.0, " deg/min"};
  if (unit == "m") return {1e3, " mm"};
  if (unit == "rad") return {geometry::kDegrees, " deg"};
  if (unit == "s") return {1e3, " ms"};
  return {100.0, " %"};
}

ShownUnit shown_unit(const std::string& unit) {
  if (unit.empty()) return {100.0, "%"};
  if (unit == "rad") return {geometry::kDegrees, "\u00b0"};
  if (unit == "rad/s") return {geometry::kDegrees, "\u00b0/s"};
  if (unit == "m") return {1000.0, "mm"};
  if (unit == "s") return {1000.0, "ms"};
  return {1.0, unit};
}

std::string shown(double value, const std::string& unit) {
  const ShownUnit as = shown_unit(unit);
  return two_digits(as.factor * value) + (as.name.starts_with("\u00b0") ? "" : " ") + as.name;
}

std::string variable_in_words(const std::string& variable) {
  return variable == "turn_rate"    ? "turn rate"
         : variable == "t"          ? "time"
         : variable == "distance"   ? "distance driven"
         : variable == "arc_angle"  ? "angle turned while driving"
         : variable == "spin_angle" ? "angle turned on the spot"
                                    : variable;
}

std::string variables_in_words(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    result += variable_in_words(word);
    if (space < text.size()) result += ' ';
    at = space + 1;
  }
  return result;
}

std::string place_text(const Vector2& place) {
  return fmt::format("x {:.1f} m, y {:.1f} m", place.x(), place.y());
}

}  // namespace trussmap::wording
