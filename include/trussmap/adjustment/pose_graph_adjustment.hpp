// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The best fit of a pose graph: the estimates of least chi^2, found from any start.
//
//   1. Several sets of headings are drawn from the measurements alone: linear fits whose whole
//      turns come from different trees, and the chordal relaxation (pose_graph_headings.hpp).
//      Positions given headings are one linear solve.
//   2. The best start descends by Gauss-Newton steps; a step that does not pay is damped
//      (Levenberg-Marquardt), so that chi^2 never rises. It ends when the next step would take
//      less than `tolerance` of chi^2, and takes that step too.
//   3. Whatever start has other windings than what was found, or lies lower, descends as well, and
//      if chi^2 is too large for its degrees of freedom so do all others. The best is kept.
//
// What fails: a graph in several parts, a vertex that its measurements leave free. Both are
// SolveErrors that name vertices; nothing is hidden by damping. Local minima: with heading errors
// of some 0.3 rad per edge and few loops, no one can say that a lower minimum does not exist;
// result.warnings says what is suspicious.
#pragma once

#include "trussmap/adjustment/pose_graph.hpp"

#include <string>
#include <vector>

namespace trussmap {

enum class StartFrom {
  best,     ///< the file's estimates, if any, and the measurements
  file,     ///< the same, but the file's estimates must be there, and descend in any case
  odometry  ///< the measurements alone: estimates serve to place the held vertex only
};

struct AdjustmentOptions {
  StartFrom start = StartFrom::best;
  int max_iterations = 200;  ///< per descent
  double tolerance = 1e-13;  ///< relative decrease of chi^2 that a next step may still promise
};

struct PoseGraphAdjustment {
  std::vector<Pose> estimates;  ///< per vertex, map frame; headings in (-pi, pi]
  double chi2 = 0.0;            ///< sum of e' Omega e
  int dof = 0;                  ///< measured values less unknowns
  int iterations = 0;           ///< of the descent that found it
  double gradient_norm = 0.0;   ///< 2-norm of the gradient of chi^2, 1/m and 1/rad
  bool converged = false;
  std::string start;  ///< which start led there, in words
  std::vector<std::string> warnings;
};

/// Throws std::invalid_argument on a graph with a fault (find_fault), SolveError on one that has
/// no single best fit.
[[nodiscard]] PoseGraphAdjustment adjust(const PoseGraph& graph,
                                         const AdjustmentOptions& options = {});

/// Covariance of each of the chosen vertices (by place in the list) at `estimates`: 3x3 for a
/// pose, 2x2 for a point, in map axes, zero where held. By columns of the inverse normal matrix:
/// one factorisation and a solve per unknown. Throws like adjust.
[[nodiscard]] std::vector<Eigen::MatrixXd> marginal_covariances(const PoseGraph& graph,
                                                                const std::vector<Pose>& estimates,
                                                                const std::vector<int>& vertices);

}  // namespace trussmap
