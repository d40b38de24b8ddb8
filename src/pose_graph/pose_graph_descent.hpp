// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Downhill from one start, and a look at the bottom: is it a point or a valley?
#pragma once

#include "linalg/levenberg_marquardt.hpp"
#include "pose_graph/pose_graph_system.hpp"

#include <vector>

namespace trussmap::pose_graph {

struct Descent {
  std::vector<Pose> estimates;
  double chi2 = 0.0;
  int iterations = 0;          ///< steps taken
  double gradient_norm = 0.0;  ///< 2-norm of the gradient of chi^2
  bool converged = false;
};

/// Levenberg-Marquardt. The system is left linearised at the result.
[[nodiscard]] Descent descend(PoseGraphSystem& system, std::vector<Pose> start,
                              const linalg::DescentOptions& options);

/// Positions by the one linear solve that the headings leave.
[[nodiscard]] std::vector<Pose> fit_positions(PoseGraphSystem& system,
                                              const std::vector<Pose>& estimates);

/// Vertices that can move without changing any measurement, most mobile first; none if all is
/// determined.
[[nodiscard]] std::vector<int> find_loose_vertices(PoseGraphSystem& system,
                                                   const std::vector<Pose>& estimates);

}  // namespace trussmap::pose_graph
