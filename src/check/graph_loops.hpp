// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Loops given the wrong way round: the pose of the first vertex seen from the second.
//
//   a     squared error of a loop as given          e' Omega e at the fit
//   b     the same of the loop reversed
//   s^2   what such a square is made of by noise    of the loops that the fit suits, per value
//
// Two questions: do all loops fit when all are reversed? If not, which ones do? For the second each
// loop stands in the graph both ways, at half weight: the two pull to either side of the truth, so
// that such a fit closes the loops up to the length of a closure, however far dead reckoning was
// off. Then the weights follow the better of the two, step by step (deterministic annealing: Rose,
// "Deterministic annealing for clustering, compression, classification, regression, and related
// optimization problems", 1998), a loop that fits neither way losing both.
#pragma once

#include "check/graph_fit.hpp"

#include <optional>
#include <vector>

namespace trussmap::check {

struct ReversedLoops {
  std::vector<int> edges;  ///< places in pose_edges, ascending
  bool all = false;        ///< of the loops
  double before = 0.0;     ///< chi^2 as given
  double after = 0.0;      ///< with these reversed
};

/// `graph` is tied together; `loops` are places in its pose_edges; `as_given` is its fit, `trusted`
/// says whether chi^2 can be held against its degrees of freedom. Nothing where reversing explains
/// nothing, or not nearly all.
[[nodiscard]] std::optional<ReversedLoops> reversed_loops(const PoseGraph& graph,
                                                          const std::vector<int>& loops,
                                                          const GraphFit& as_given, bool trusted);

}  // namespace trussmap::check
