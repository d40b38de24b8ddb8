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
// section 3.3. On a lattice of unequal routes the change reached exceeds the one desired (gain
// up to 2 and more), and the map diverges: limited_gain() is the repair.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>

namespace trussmap {

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

/// Factor <= 1 for all displacements such that the change obtained on the route, `obtained` =
/// u_j - u_i, stays within `limit` of the one desired: 1 or limit/alpha with
/// alpha = max(obtained.desired/|desired|^2, |obtained|/|desired|), desired = w - d.
[[nodiscard]] double limited_gain(const Vector2& obtained, const Vector2& desired, double limit);

}  // namespace trussmap
