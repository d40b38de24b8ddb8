// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Checks of option values that complain in plain words.
#pragma once

#include "command_line.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace trussmap::app {

/// The finite number that the whole text is.
[[nodiscard]] std::optional<double> finite_number(std::string_view text);

/// A number above 0, from 1e-15 to 1e15: squares of others overflow.
[[nodiscard]] Check above_zero();

/// A length of a robot, as model files may have it: 0.1 mm to 10 km.
[[nodiscard]] Check length_of_robot();

/// Where something sits on a robot: a number of at most 10^4 in size.
[[nodiscard]] Check length_to_place();

/// A number from 0 to 1e15.
[[nodiscard]] Check zero_or_more();

/// A whole number from `least` on.
[[nodiscard]] Check whole_number(std::uint64_t least);

/// "FROM:TO" or "N:FROM:TO": s, FROM below TO, of recording N, from 1 on.
[[nodiscard]] Check stretch_of_time();

struct StretchOfTime {
  std::optional<std::size_t> recording;  ///< from 0 on; absent: of the only one
  TimeSpan time;
};

/// What stretch_of_time() let through.
[[nodiscard]] StretchOfTime parse_stretch(const std::string& text);

/// A number of landmarks from 2 to 10^9, "all", "estimated" or "auto".
[[nodiscard]] Check eta_text();

}  // namespace trussmap::app
