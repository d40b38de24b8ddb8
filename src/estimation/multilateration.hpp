// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a beacon is, by ranges alone that were measured along a path.
//
//   minimise over p   sum of rho((|p - q_k| - r_k) / s_k)       q_k: the sensor, r_k: the range
//
// with rho square within two standard deviations and linear beyond (Huber). From one straight line
// there are two minima, mirror images: all of a circle round the nearest reading are tried as
// starts, and a place is certain where no other explains the ranges nearly as well.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>
#include <vector>

namespace trussmap::estimation {

struct RangeReading {
  Vector2 from = Vector2::Zero();  ///< m
  double range = 0.0;              ///< m
  double sd = 1.0;                 ///< m, of the range and of where it was measured
};

struct Multilateration {
  Vector2 place = Vector2::Zero();  ///< m, the best
  /// The best of the others, where one explains the ranges nearly as well.
  std::optional<Vector2> mirror;
  bool certain =
      false;  ///< there is none, and the place is far better known than the ranges are long
};

/// Nothing with fewer than three readings.
[[nodiscard]] std::optional<Multilateration> multilaterate(
    const std::vector<RangeReading>& readings);

}  // namespace trussmap::estimation
