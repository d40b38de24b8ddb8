// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Refinement as the paper prints it: the forces of the reference structure (refinement.hpp) on a
// larger part of the map. Golfarelli, Maio & Rizzi (1998), section 3.3.
//
//   whole map   every route, the first landmark held
//   a part      the routes with both ends in it, floating: the load that would move it as a whole
//               is projected out, the displacement is the shortest, and the map counts as shifted
//               so that its first landmark stays
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/planar.hpp"

#include <vector>

namespace trussmap::map {

/// Displacements of some landmarks (ascending), not yet made.
struct Moves {
  std::vector<int> landmarks;
  std::vector<Vector2> displacements;
  Vector2 shift = Vector2::Zero();  ///< of the whole map, afterwards

  /// Zero for a landmark that is not among them.
  [[nodiscard]] Vector2 of(int landmark) const;
};

/// The paper's stiffness of a route as it lies in the map.
[[nodiscard]] Matrix2 printed_stiffness(const LandmarkGraph& map, const Route& route);

/// The route's averages hold its last traversal; `members`: landmarks of the larger structure,
/// ascending, the route's ends among them. Throws SolveError.
[[nodiscard]] Moves printed_refinement(const LandmarkGraph& map, int route,
                                       std::vector<int> members);

}  // namespace trussmap::map
