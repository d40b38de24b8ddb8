// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a shape may speak of, by name; what it means stands in drive/row_variables.hpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trussmap::recording {

/// Names that a covariate may not have, and a shape may always use.
[[nodiscard]] const std::vector<std::string>& reserved_variables();
/// starts, spins, reverses_left, reverses_right.
[[nodiscard]] bool is_event(std::string_view variable);
/// speed, turn_rate, acceleration, curvature: smoothed within one kind of motion.
[[nodiscard]] bool is_rate(std::string_view variable);

/// "m/s" of speed; "" of what has none, or whose unit nobody states.
[[nodiscard]] std::string_view unit_of_variable(std::string_view variable);

}  // namespace trussmap::recording
