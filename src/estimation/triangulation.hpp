// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a landmark is, by directions alone in which it was seen along a path.
//
//   minimise over p   sum of rho(angle between p - q_k and a_k, over s_k)
//                                         q_k: the sensor, a_k: the direction, map axes
//
// with rho square within two standard deviations and linear beyond (Huber). Starts lie where sights
// cross that look most differently, and along the first one. Whoever drives straight at a landmark
// never learns how far it is.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>
#include <vector>

namespace trussmap::estimation {

struct DirectionReading {
  Vector2 from = Vector2::Zero();  ///< m
  double direction = 0.0;          ///< rad, map axes
  double sd = 1.0;                 ///< rad
};

struct Triangulation {
  Vector2 place = Vector2::Zero();  ///< m, the best
  bool certain = false;             ///< far better known than it is distant
};

/// Nothing with fewer than two readings, or where all sights are along one line.
[[nodiscard]] std::optional<Triangulation> triangulate(
    const std::vector<DirectionReading>& readings);

}  // namespace trussmap::estimation
