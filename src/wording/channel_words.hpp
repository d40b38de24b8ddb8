// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Words and units of channels, variables and places, for sentences and charts.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/planar.hpp"

#include <string>

namespace trussmap::wording {

/// In what a person reads a channel's g: the factor to it, and the unit in plain text.
struct Scale {
  double factor;
  const char* unit;
};
[[nodiscard]] Scale scale_of(Channel channel);

/// Charts and pages show % for "", degrees for rad, mm for m.
struct ShownUnit {
  double factor = 1.0;
  std::string name;
};
[[nodiscard]] ShownUnit shown_unit(const std::string& unit);
/// A value with the unit it is shown in: "2.1 mm", "0.31°", "4 %". Two digits.
[[nodiscard]] std::string shown(double value, const std::string& unit);

/// "turn rate" for turn_rate, and so on.
[[nodiscard]] std::string variable_in_words(const std::string& variable);
/// The same for the variables among several words.
[[nodiscard]] std::string variables_in_words(const std::string& text);

/// "x 12.3 m, y 9.8 m".
[[nodiscard]] std::string place_text(const Vector2& place);

}  // namespace trussmap::wording
