// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A place or threshold that was sought is as uncertain as a coefficient, and a coefficient is less
// certain for it: with a circle a little larger the floor is a little less slippery.
//
//   M   columns of the coefficients         both less what landmarks, poses and other effects
//   D   what a unit of each parameter       absorb
//       adds, sum of a df/dp
//
//   covariance of (a, p) = ([M D]'[M D] + prior of p)^-1           (Gauss and Newton)
#pragma once

#include "criticism/candidates.hpp"

#include <vector>

namespace trussmap::criticism {

/// By what the standard errors of an effect's coefficients grow for the uncertainty of its
/// parameters, each at least 1; all 1 where it has none. `others`: columns, less what the map
/// absorbs, of all else that was estimated.
[[nodiscard]] std::vector<double> widening(const ScoreTest& tests, const Candidate& found,
                                           const std::vector<double>& coefficients,
                                           const Eigen::MatrixXd& others);

/// The standard errors of a fit's effects, for places and thresholds that were sought. `found`: one
/// per effect, empty for those that were not.
void widen_for_places(ModelFit& fit, const std::vector<Candidate>& found);

}  // namespace trussmap::criticism
