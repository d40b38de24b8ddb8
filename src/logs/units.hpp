// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Units that logs have, by their names in map.toml.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trussmap::logs {

enum class Quantity { none, length, angle, time, speed, turn_rate, ticks };

struct Unit {
  std::string_view name;
  Quantity quantity;
  double si;  ///< of one, in m, rad, s, m/s, rad/s; 1 of ticks and of none
};

/// By its name or another spelling ("degrees", "mm/s", "µs"); none where it is unknown.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view name);

/// The unit that a name ends in: "Left (mm)", "left [mm]", "left_mm", "left mm", "leftMm".
[[nodiscard]] std::optional<Unit> unit_in(const std::string& name);

/// Names of the units of this quantity, with commas between.
[[nodiscard]] std::string unit_names(Quantity quantity);

}  // namespace trussmap::logs
