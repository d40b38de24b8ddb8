// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What has to be held so that a pose graph has one best fit and not a family of them.
//
// Relative measurements say nothing of where the whole lies:
//
//   poses, with or without points seen from them    shift and turn are free: hold one pose
//   points tied by map-frame displacements          shift is free: hold one point's position
//   both                                            shift is free, the displacements carry the
//                                                   direction: hold one position
//
// Vertices fixed in the file come first. Whatever is still free is not held but refused: parts of
// the graph that nothing ties together here, and single vertices that can still move (a pose that
// sees one point) by the solver, which notices that the factor breaks down.
#pragma once

#include "estimation/held_unknowns.hpp"
#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace trussmap::pose_graph {

/// Vertices that measurements tie together.
struct GraphPart {
  std::vector<int> vertices;  ///< ascending
  int fixed_poses = 0;
  int fixed_points = 0;
  bool has_displacements = false;
  std::optional<int> first_pose;

  [[nodiscard]] bool is_fixed() const { return fixed_poses + fixed_points > 0; }
};
/// In the order of their first vertices. An edge without information ties nothing.
[[nodiscard]] std::vector<GraphPart> graph_parts(const PoseGraph& graph);

/// Per vertex, bits of Held. Throws SolveError, naming vertices of each, if the graph falls into
/// parts of which one has no fixed vertex.
[[nodiscard]] std::vector<std::uint8_t> choose_gauge(const PoseGraph& graph);

/// Number of unknowns that are left.
[[nodiscard]] int count_unknowns(const PoseGraph& graph, const std::vector<std::uint8_t>& held);

/// Number of independent measured values: the ranks of all information matrices.
[[nodiscard]] int count_measurements(const PoseGraph& graph);

}  // namespace trussmap::pose_graph
