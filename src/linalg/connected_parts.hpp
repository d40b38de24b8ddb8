// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "linalg/front_tree.hpp"

#include <vector>

namespace trussmap {

/// The connected part of each of `nodes` nodes, named by its lowest node. Pairs are of these nodes,
/// in any order, any number of times. Cost: all but linear.
[[nodiscard]] std::vector<int> connected_parts(int nodes, const std::vector<NodePair>& pairs);

}  // namespace trussmap
