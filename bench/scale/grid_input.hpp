// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Raw measurements of square grids: n x n landmarks 1 m apart, routes between neighbours.
#pragma once

#include "trussmap/planar.hpp"

#include <vector>

namespace trussmap::bench {

struct RawMeasurement {
  int i = 0, j = 0;
  Vector2 displacement = Vector2::Zero();  ///< m
  Matrix2 information = Matrix2::Zero();   ///< 1/m^2
};

struct Grid {
  std::vector<Vector2> about;  ///< rough positions, 0.2 m off, m
  std::vector<RawMeasurement> measurements;
};

/// Every route measured `repeats` times, in random order.
[[nodiscard]] Grid make_grid(int side, int repeats, unsigned seed);

}  // namespace trussmap::bench
