// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Nested dissection by coordinates: an order of elimination for maps, whose nodes lie in the plane
// and are coupled to near ones.
//
//     o o o | o o o      the nodes are cut in two halves across their longer extent; those of one
//     o o o | o o o      half that are coupled to the other separate the halves and come last.
//     o o o | o o o      Each half is cut in the same way.
//
// On a square of n x n nodes the factor has about 31/4 n^2 log2 n blocks and takes about 10 n^3
// block operations, which no order can improve on but by a factor (George, "Nested dissection of
// a regular finite element mesh", 1973). Positions may be rough: they only choose the cuts.
//
// Cost: O((nodes + pairs) log nodes).
#pragma once

#include "linalg/front_tree.hpp"
#include "trussmap/planar.hpp"

#include <vector>

namespace trussmap::linalg {

/// An order of elimination of all nodes. `positions`: one per node, m. Throws
/// std::invalid_argument on a pair out of range.
[[nodiscard]] std::vector<int> dissection_order(const std::vector<Vector2>& positions,
                                                const std::vector<NodePair>& pairs);

}  // namespace trussmap::linalg
