// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Refinement: a known route i-j was driven again, and the map should move towards its averages.
//
//        h                     k           hatched: held
//     ///o==B_ih==o-----B_ij-----o==B_jk==o///
//                 i              j
//
//   w      s (cos theta, sin theta), the route's mean stretch and orientation     m
//   d      p_j - p_i, the route in the present map                                m
//   u_j    (w - d)/2 = -u_i: the desired displacement, a rotation about the midpoint
//   f_i    B_ij (u_i - u_j) + B_ih u_i
//   f_j    B_ij (u_j - u_i) + B_jk u_j      the forces that bring it about on the reference
//                                           structure: ij and, at each end, the stiffest other
//                                           driven route (none: the term is absent)
//
// The forces are then applied to a larger part of the map. Golfarelli, Maio & Rizzi (1998),
// section 3.3. The change reached on a lattice exceeds the one desired where bars are stiffer one
// way than the other: at a ratio of 9 by 1.13, at 36 by 2, and beyond the map diverges (near
// borders earlier: measured on 6x6 landmarks from about 10 on). Relaxation (truss/relaxation.hpp)
// does not.
#pragma once

#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"

#include <optional>

namespace trussmap::map {

struct RefinementLoads {
  Vector2 desired_i = Vector2::Zero();  ///< m
  Vector2 desired_j = Vector2::Zero();  ///< m
  Vector2 force_i = Vector2::Zero();
  Vector2 force_j = Vector2::Zero();
};

/// Forces on the reference structure. `present` = d, `target` = w; stiffnesses are 2x2 blocks in
/// map axes, t counting the new traversal; the adjacent ones absent where there is no such route.
[[nodiscard]] RefinementLoads refinement_loads(const Vector2& present, const Vector2& target,
                                               const Matrix2& stiffness,
                                               const std::optional<Matrix2>& adjacent_i,
                                               const std::optional<Matrix2>& adjacent_j);

/// A correction that came out as no number.
[[nodiscard]] SolveError too_many_magnitudes();

}  // namespace trussmap::map
