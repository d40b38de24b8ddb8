// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/connected_parts.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <numeric>

namespace trussmap {

std::vector<int> connected_parts(int nodes, const std::vector<NodePair>& pairs) {
  std::vector<int> part(idx(nodes));
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&part](int node) {
    while (part[idx(node)] != node) {
      int& up = part[idx(node)];
      up = part[idx(up)];
      node = up;
    }
    return node;
  };
  for (const auto& [i, j] : pairs) {
    const int a = root(i);
    const int b = root(j);
    part[idx(std::max(a, b))] = std::min(a, b);
  }
  for (int node = 0; node < nodes; ++node) part[idx(node)] = root(node);
  return part;
}

}  // namespace trussmap
