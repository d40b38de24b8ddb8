// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Headings from a problem with more room: where noise is so large that descents from any drawn
// start end in local minima, lifting the unknowns to more dimensions removes most of these.
//
// In the plane a heading is a unit complex number y, a position a complex number p, and the
// chordal cost of all measurements is
//
//   F = sum kappa |y_j - z y_i|^2 + tau |p_j - p_i - t y_i|^2
//
//   z, t        measured turn (unit) and translation; a displacement in map axes has y_i = 1
//   kappa, tau  information on the turn, 1/rad^2, and on a coordinate of the translation, 1/m^2
//
// The lifted problem lets y be a unit vector of C^r and p any vector of C^r. Its minimum for large
// enough r is that of a semidefinite relaxation, which up to considerable noise is the true one
// (Rosen, Carlone, Bandeira & Leonard, "SE-Sync", 2019; r = 3 is ample in practice). It is sought
// by conjugate gradients on the product of spheres, preconditioned by the factor of F's constant
// Hessian, and brought back to the plane along its principal direction.
#pragma once

#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace trussmap::pose_graph {

/// Estimates with headings and positions of the lifted minimum; held parts stand as they are held.
/// `order`: of elimination, of all vertices. Every now and then `enough` is shown what the search
/// would return so far and may end it. Deterministic; `seed` varies where the search begins.
[[nodiscard]] std::vector<Pose> solve_lifted(
    const PoseGraph& graph, const std::vector<std::uint8_t>& held, const std::vector<int>& order,
    std::uint64_t seed, const std::function<bool(const std::vector<Pose>&)>& enough);

}  // namespace trussmap::pose_graph
