// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/connected_parts.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <numeric>

namespace trussmap {

DisjointSets::DisjointSets(int nodes) : up_(idx(nodes)) {
  std::iota(up_.begin(), up_.end(), 0);
}

int DisjointSets::lowest(int node) {
  while (up_[idx(node)] != node) {
    int& up = up_[idx(node)];
    up = up_[idx(up)];
    node = up;
  }
  return node;
}

void DisjointSets::join(int a, int b) {
  a = lowest(a);
  b = lowest(b);
  up_[idx(std::max(a, b))] = std::min(a, b);
}

std::vector<int> connected_parts(int nodes, const std::vector<NodePair>& pairs) {
  DisjointSets sets(nodes);
  for (const auto& [i, j] : pairs) sets.join(i, j);
  std::vector<int> part(idx(nodes));
  for (int node = 0; node < nodes; ++node) part[idx(node)] = sets.lowest(node);
  return part;
}

}  // namespace trussmap
