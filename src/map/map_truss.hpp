// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The truss that a landmark map is: a bar for every route, with the paper's stiffness, and what it
// does under the loads of its routes' averages.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/truss.hpp"

#include <optional>
#include <vector>

namespace trussmap {

class NearestLandmarks;

/// Displacements of some landmarks (ascending), not yet made.
struct Moves {
  std::vector<int> landmarks;
  std::vector<Vector2> displacements;
  Vector2 shift = Vector2::Zero();  ///< of the whole map, afterwards

  /// Zero for a landmark that is not among them.
  [[nodiscard]] Vector2 of(int landmark) const;
};

/// Throws SolveError unless all displacements are finite.
void require_finite(const Moves& moves);

/// A map's truss at this moment. Holds references to the map and to the index of its landmarks,
/// which a fixed eta alone needs.
class MapTruss {
 public:
  MapTruss(const LandmarkGraph& map, const NearestLandmarks& nearest)
      : map_(map), nearest_(nearest) {}

  /// The paper's stiffness of a route as it lies in the map.
  [[nodiscard]] Matrix2 stiffness(const Route& route) const;

  /// The second phase: a route is pulled towards its averages, within the structure that `eta`
  /// says; its gain is limited unless there is no limit. Throws SolveError.
  [[nodiscard]] Moves refinement(int route, const Eta& eta,
                                 const std::optional<double>& gain_limit) const;

  /// The whole truss under every route's pull towards its averages, the first landmark held.
  /// Throws SolveError.
  [[nodiscard]] Moves rest() const;

 private:
  struct Piece;

  /// From its source to its target, as the map has them, m.
  [[nodiscard]] Vector2 lies(const Route& route) const;
  [[nodiscard]] std::optional<Matrix2> stiffest_neighbour(int landmark, int except) const;
  [[nodiscard]] Moves larger_structure(const Route& route, const Eta& eta,
                                       const std::vector<Load>& loads) const;
  [[nodiscard]] Moves growing_structure(const Route& route, const Eta& eta,
                                        const std::vector<Load>& loads) const;
  [[nodiscard]] std::vector<int> next_ring(const std::vector<int>& members,
                                           const std::vector<int>& ring) const;
  [[nodiscard]] bool hardly_moves(const Moves& moves, const std::vector<int>& ring) const;
  void fetch(const std::vector<int>& members) const;
  [[nodiscard]] Piece everything() const;
  [[nodiscard]] Piece piece_of(std::vector<int> members) const;
  [[nodiscard]] Piece connected_to(int i, std::vector<int> members) const;
  [[nodiscard]] Moves deflect(const Piece& piece, std::vector<Load> loads, bool held) const;

  const LandmarkGraph& map_;
  const NearestLandmarks& nearest_;
};

}  // namespace trussmap
