// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The best fit of a pose graph of which some loop closures are wrong.
//
//   r^2    e' Omega e of an edge
//   c^2    the largest r^2 that a right edge should have: `gate`
//   w      an edge's weight, 0 ... 1
//
// Minimises the truncated squares sum min(r^2, c^2) over the loop closures plus the plain squares
// of all else, by graduated non-convexity (Yang, Antonante, Tzoumas & Carlone, "Graduated
// non-convexity for robust spatial perception", 2020): first all edges pull nearly alike, then the
// cost is bent, step by step, into the truncated one. Edges that end outside the gate are left
// out, the rest is adjusted as usual.
//
// A loop closure is a pose edge between poses that do not follow each other in the list of
// vertices. Odometry and points are believed. An edge without which the graph would fall apart is
// kept. The gate takes the information at its word: where it claims too much, right edges fall.
#pragma once

#include "trussmap/adjustment/pose_graph_adjustment.hpp"

#include <vector>

namespace trussmap {

struct RobustOptions {
  AdjustmentOptions adjustment;
  double gate = 16.27;  ///< c^2: one right edge in a thousand has more (chi^2, 3 dof)
};

struct RobustAdjustment {
  PoseGraphAdjustment adjustment;  ///< of the edges kept: chi2, dof and warnings are theirs
  std::vector<int> left_out;       ///< places in graph.pose_edges, ascending
};

/// Throws like adjust.
[[nodiscard]] RobustAdjustment adjust_robustly(const PoseGraph& graph,
                                               const RobustOptions& options = {});

}  // namespace trussmap
