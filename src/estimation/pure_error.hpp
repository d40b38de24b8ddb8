// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Do the map's routes misfit because traversals scatter, or because something is missing?
//
//   z_k, C_k   one traversal of a route, its covariance                         m, m^2  map frame
//   W, m       sum of C_k^-1; mean W^-1 (sum of C_k^-1 z_k)                     1/m^2, m
//   d          the route in the least-squares map                               m
//
//   sum (z_k - d)' C_k^-1 (z_k - d)  =  sum (z_k - m)' C_k^-1 (z_k - m)  +  (m - d)' W (m - d)
//          total                                pure error                     lack of fit
//
// for each route, and so for the map: repeats of a route act as one bar of stiffness W that wants
// the length m, and their scatter about m is no map's fault. Degrees of freedom: 2 per repeat after
// a route's first; 2 (routes - landmarks + 1). Their mean squares have the ratio F, Fisher's where
// only noise is at work: whatever the noise's scale, so a covariance believed too small or too
// large does not matter. An effect that repeats with its route shows in the lack of fit alone.
//
// Draper & Smith, "Applied Regression Analysis" (1998), section 2.1.
#pragma once

#include "trussmap/landmark_map.hpp"

#include <vector>

namespace trussmap::estimation {

/// One traversal of the route between two landmarks (numbers in the map), either way.
struct Repeat {
  int from = -1;
  int to = -1;
  Traversal traversal;
};

/// All traversals of a route as one element, in the direction of the first.
struct MergedRoute {
  int source = -1;
  int target = -1;
  int count = 0;
  Vector2 mean = Vector2::Zero();       ///< m, source -> target
  Matrix2 stiffness = Matrix2::Zero();  ///< W, 1/m^2
  double scatter = 0.0;                 ///< pure error of this route: chi^2 of 2 (count - 1) dof
};

/// In order of first traversal. Throws std::invalid_argument on a covariance that is not positive
/// definite.
[[nodiscard]] std::vector<MergedRoute> merge_repeats(const std::vector<Repeat>& repeats);

struct PureErrorSplit {
  double pure_error = 0.0;  ///< chi^2
  int pure_error_dof = 0;
  double lack_of_fit = 0.0;  ///< chi^2
  int lack_of_fit_dof = 0;
  double F = 0.0;        ///< 0 where either has no degree of freedom: nothing can be tested
  double p_value = 1.0;  ///< chance of an F as large from noise alone
  LandmarkGraph map;     ///< the least-squares map of the merged routes, the first landmark held
};

/// `map` gives the landmarks; its routes do not count. Throws as merge_repeats and adjust_linear.
[[nodiscard]] PureErrorSplit split_pure_error(const LandmarkGraph& map,
                                              const std::vector<Repeat>& repeats);

}  // namespace trussmap::estimation
