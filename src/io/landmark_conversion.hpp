// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark map as a pose graph of points, and back.
//
//   t, C, d    a route's traversals, mean covariance of one (m^2), mean displacement (m)
//   Omega      t C^-1, the information of the mean displacement: the Gauss-Markov stiffness
//
// Landmarks become points, routes displacements; the first landmark is fixed. The way back cannot
// know how many traversals an edge stands for: it makes one of each edge, with C = Omega^-1, and
// several edges between the same two points become one route whose t C^-1 is the sum of theirs.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/pose_graph.hpp"

namespace trussmap::io {

/// Ids are the landmarks' names where these are all whole numbers, else 0, 1, ... Throws
/// std::invalid_argument where a route has no traversal or its covariance is not positive definite.
[[nodiscard]] PoseGraph to_pose_graph(const LandmarkGraph& map);

/// Names are the ids. Throws std::invalid_argument, in the user's words, on a graph with poses, a
/// point without an estimate, or information that is not positive definite.
[[nodiscard]] LandmarkGraph to_landmark_graph(const PoseGraph& graph);

}  // namespace trussmap::io
