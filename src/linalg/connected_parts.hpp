// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which nodes hang together: disjoint sets, joined pair by pair (Tarjan, "Efficiency of a good but
// not linear set union algorithm", 1975). Cost: all but linear in nodes and pairs.
#pragma once

#include "linalg/front_tree.hpp"

#include <vector>

namespace trussmap::linalg {

/// Sets of the nodes 0, 1, ..., each named by its lowest node; at first every node is alone.
class DisjointSets {
 public:
  explicit DisjointSets(int nodes);

  /// The lowest node of the set that holds this one.
  [[nodiscard]] int lowest(int node);
  void join(int a, int b);

 private:
  std::vector<int> up_;  ///< a node of the same set that is no higher
};

/// The connected part of each of `nodes` nodes, named by its lowest node. Pairs are of these nodes,
/// in any order, any number of times.
[[nodiscard]] std::vector<int> connected_parts(int nodes, const std::vector<NodePair>& pairs);

}  // namespace trussmap::linalg
