// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Batch least squares on the truss: every route at once.
//
//   minimise  sum over routes of t (p_j - p_i - d)' C^-1 (p_j - p_i - d)
//
// with d the route's mean displacement, C the mean covariance of a traversal and t their number;
// the first landmark stays where it is. In the truss's words: bars of stiffness t C^-1 that want
// to be as long as their measurements, relaxed. Linear, one solve, whatever the start.
#pragma once

#include "trussmap/landmark_map.hpp"

#include <vector>

namespace trussmap::map {

struct LinearAdjustment {
  LandmarkGraph map;                ///< adjusted positions; routes as given
  double chi2 = 0.0;                ///< twice the strain energy that is left
  int dof = 0;                      ///< 2 (routes - landmarks + 1): of the means, not the repeats
  std::vector<Vector2> bar_forces;  ///< per route: t C^-1 (p_j - p_i - d), 1/m
};

/// Throws SolveError where a landmark is tied to nothing.
[[nodiscard]] LinearAdjustment adjust_linear(const LandmarkGraph& map);

}  // namespace trussmap::map
