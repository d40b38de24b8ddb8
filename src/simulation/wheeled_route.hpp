// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot on two wheels that turns on the spot at a landmark and drives straight to the next one,
// exactly; what its wheels say of that is noisy.
//
//   recorded travel of a wheel in a row = true travel d + k sqrt(|d|) e,   e standard normal
#pragma once

#include <random>
#include <vector>

namespace trussmap {

struct RecordedRow {
  double left = 0.0;   ///< m, signed travel
  double right = 0.0;  ///< m
};

/// Rows as recorded: of a turn on the spot by `turn` (rad), then of `length` (m)
/// straight on. `wheelbase` in m, `noise`: k of both wheels, m^(1/2).
[[nodiscard]] std::vector<RecordedRow> drive_route(double turn, double length, double wheelbase,
                                                   double noise, std::mt19937_64& random);

}  // namespace trussmap
