// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Figures as cells of a table, alike in texts and on pages.
#pragma once

#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <string>
#include <vector>

namespace trussmap::report {

/// The value, and "\u00b1" with its standard error; empty without one.
[[nodiscard]] std::vector<std::string> quantity_cells(const Estimate& estimate);

/// "0.336 \u00b1 0.001"; the value alone without an error.
[[nodiscard]] std::string with_error(double value, double standard_error);

/// How many runs end within 1, 2 and 3 standard deviations, and how many are expected to: a
/// heading, and a row per plane.
[[nodiscard]] std::vector<std::string> sigma_heading();
[[nodiscard]] std::vector<std::vector<std::string>> sigma_rows(const StatedNoise& stated);

}  // namespace trussmap::report
