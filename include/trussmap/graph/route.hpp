// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A route between two landmarks and what its traversals say on average.
//
//   t        number of traversals
//   s        stretch, running mean of the measured lengths                              m
//   theta    orientation of the route's own direction, source -> target: running mean of the
//            measured directions, each unwrapped next to the present mean; not folded   rad
//   d        running mean of the measured displacement vectors, source -> target        m
//   C        running mean of the traversals' covariances, map axes                      m^2
//
// Golfarelli, Maio & Rizzi (1998), section 3; the paper folds orientations to [0, pi), which here
// is done for printing and files only (an undirected route has no direction to average).
#pragma once

#include "trussmap/core/planar.hpp"

namespace trussmap {

/// One drive along a route: what odometry measured, in map axes.
struct Traversal {
  Vector2 displacement = Vector2::Zero();  ///< from where it began to where it ended, m
  Matrix2 covariance = Matrix2::Zero();    ///< of the displacement, m^2
};

/// The same drive the other way round.
[[nodiscard]] Traversal reversed(const Traversal& traversal);

struct Route {
  int source = -1;  ///< landmark
  int target = -1;  ///< landmark
  int traversals = 0;
  double stretch = 0.0;                    ///< m
  double orientation = 0.0;                ///< rad, source -> target, not folded
  Vector2 displacement = Vector2::Zero();  ///< m, source -> target
  Matrix2 covariance = Matrix2::Zero();    ///< m^2, of one traversal

  /// s (cos theta, sin theta): what the paper's refinement steers to.
  [[nodiscard]] Vector2 mean_vector() const;
};

/// Takes a traversal from source to target into the averages.
void average_in(Route& route, const Traversal& traversal);

/// Orientation folded to [0, pi), as the paper prints it.
[[nodiscard]] double folded_orientation(double orientation);

}  // namespace trussmap
