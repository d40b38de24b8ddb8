// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The plan of a frontal factorisation: which nodes are eliminated together, and on what they leave
// their mark (Irons, "A frontal solution program for finite element analysis", 1970; Duff & Reid,
// "The multifrontal solution of indefinite sparse symmetric linear equations", 1983).
//
//        front      a dense part of the matrix: the nodes eliminated in it come first, the rows
//                   that they touch below; its parent takes over what is left for these rows
//
//   width     unknowns eliminated in a front
//   height    unknowns of the rows that remain
//
// Consecutive nodes with the same rows share a front. Small fronts join their parents where the
// zeros that this stores are few: long thin fronts are slow.
//
// Cost: about proportional to the entries of the pattern and the rows of all fronts.
#pragma once

#include <array>
#include <vector>

namespace trussmap::linalg {

using NodePair = std::array<int, 2>;

/// Which nodes are coupled, by their place in an order of elimination: for each place the later
/// ones, ascending, each once.
struct BlockPattern {
  std::vector<int> begin{0};  ///< per place, and one past the end
  std::vector<int> later;

  [[nodiscard]] int nodes() const { return static_cast<int>(begin.size()) - 1; }
};

/// The pattern of these pairs (of a node with itself: ignored); `place` of each node, negative
/// where it does not take part.
[[nodiscard]] BlockPattern pattern_of(const std::vector<NodePair>& pairs,
                                      const std::vector<int>& place, int places);

struct Front {
  int first = 0;  ///< place of the first node eliminated here
  int last = 0;   ///< one past the last
  int width = 0;
  int height = 0;
  int parent = -1;     ///< front that takes over the rows; -1: there are none
  int rows_begin = 0;  ///< in FrontTree::rows
  int rows_end = 0;
};

struct FrontTree {
  std::vector<int> order;     ///< new place k was place order[k]: the same fill, fronts contiguous
  std::vector<Front> fronts;  ///< children before parents; places are new ones
  std::vector<int> rows;      ///< places of the rows that remain, front by front, ascending
};

/// `sizes`: unknowns per place, each positive.
[[nodiscard]] FrontTree plan_fronts(const BlockPattern& pattern, const std::vector<int>& sizes);

}  // namespace trussmap::linalg
