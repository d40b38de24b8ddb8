// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/refinement.hpp"

namespace trussmap::map {

RefinementLoads refinement_loads(const Vector2& present, const Vector2& target,
                                 const Matrix2& stiffness, const std::optional<Matrix2>& adjacent_i,
                                 const std::optional<Matrix2>& adjacent_j) {
  RefinementLoads loads;
  loads.desired_j = 0.5 * (target - present);
  loads.desired_i = -loads.desired_j;
  loads.force_i = stiffness * (loads.desired_i - loads.desired_j);
  loads.force_j = -loads.force_i;
  if (adjacent_i) loads.force_i += *adjacent_i * loads.desired_i;
  if (adjacent_j) loads.force_j += *adjacent_j * loads.desired_j;
  return loads;
}

SolveError too_many_magnitudes() {
  return SolveError("the covariances of the map's traversals span too many magnitudes");
}

}  // namespace trussmap::map
