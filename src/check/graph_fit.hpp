// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A quick fit of a pose graph, to compare what it would be without a mistake: one descent or two
// instead of adjust()'s search, near linear in edges.
#pragma once

#include "trussmap/pose_graph.hpp"

#include <functional>
#include <vector>

namespace trussmap::check {

struct GraphFit {
  std::vector<Pose> estimates;
  double chi2 = 0.0;
  int dof = 0;

  [[nodiscard]] double per_dof() const { return chi2 / dof; }
};

/// Of a graph in one part, or with a fixed vertex in each.
[[nodiscard]] GraphFit fit_graph(const PoseGraph& graph);

/// e' Omega e of each pose edge.
[[nodiscard]] std::vector<double> squared_errors(const PoseGraph& graph,
                                                 const std::vector<Pose>& estimates);

/// The graph with parts that nothing ties to the rest tied loosely to the first of them: no fit of
/// it strains the ties.
[[nodiscard]] PoseGraph tied_together(PoseGraph graph);

/// Whether the edge comes back to a pose instead of going on to the next, in the list or by ids.
[[nodiscard]] bool closes_loop(const PoseGraph& graph, const PoseEdge& edge);
/// Places of such edges in pose_edges.
[[nodiscard]] std::vector<int> loop_edges(const PoseGraph& graph);

/// The graph with the information of each edge replaced.
[[nodiscard]] PoseGraph with_information(
    PoseGraph graph, const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& changed);

}  // namespace trussmap::check
