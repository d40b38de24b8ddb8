// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A first placement of every vertex from the measurements alone, by dead reckoning along a tree.
//
// Poses are chained along pose edges. Poses that only points tie to the rest form clusters of
// their own; a cluster is laid over the points it shares with what is placed already (rigidly, if
// they are two or more), the best tied cluster first. Points stand where they were first seen.
#pragma once

#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::pose_graph {

/// Which edges a pose is reached by.
enum class Tree {
  odometry,  ///< from one pose to the next in the list wherever there is such an edge
  nearest,   ///< on the way of least heading variance from the start
  strongest  ///< the edges with most heading information (maximum spanning tree)
};

/// Estimates per vertex. Held parts (see pose_graph_gauge.hpp) stand where their estimates say,
/// at zero without any; other estimates are not looked at. Headings are not wrapped: along the
/// tree they differ exactly by what was measured.
[[nodiscard]] std::vector<Pose> chain_measurements(const PoseGraph& graph,
                                                   const std::vector<std::uint8_t>& held,
                                                   Tree tree);

/// Information on the heading alone, when nothing is known of the position: the Schur complement.
[[nodiscard]] double heading_information(const PoseEdge& edge);

}  // namespace trussmap::pose_graph
