// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/connected_parts.hpp"

#include "geometry/index.hpp"

#include <numeric>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/property_map/property_map.hpp>

namespace trussmap::linalg {
namespace {

/// Of two sets the one of higher rank names both: here the one that begins lower. Ranks are never
/// the same, so none is ever raised.
struct LowerRanksHigher {
  using key_type = int;
  using value_type = int;
  using reference = int;
  using category = boost::readable_property_map_tag;

  friend int get(LowerRanksHigher /*ranks*/, int node) { return -node; }
  friend void put(LowerRanksHigher /*ranks*/, int /*node*/, int /*rank*/) {}
};

auto sets_of(std::vector<int>& up) {
  return boost::disjoint_sets<LowerRanksHigher, int*, boost::find_with_path_halving>(
      LowerRanksHigher(), up.data());
}

}  // namespace

DisjointSets::DisjointSets(int nodes) : up_(idx(nodes)) {
  std::iota(up_.begin(), up_.end(), 0);
}

int DisjointSets::lowest(int node) {
  return sets_of(up_).find_set(node);
}

void DisjointSets::join(int a, int b) {
  sets_of(up_).union_set(a, b);
}

std::vector<int> connected_parts(int nodes, const std::vector<NodePair>& pairs) {
  DisjointSets sets(nodes);
  for (const auto& [i, j] : pairs) sets.join(i, j);
  std::vector<int> part(idx(nodes));
  for (int node = 0; node < nodes; ++node) part[idx(node)] = sets.lowest(node);
  return part;
}

}  // namespace trussmap::linalg
