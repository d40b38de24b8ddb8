// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Downhill from one start, and a look at the bottom: is it a point or a valley?
#pragma once

#include "pose_graph/pose_graph_system.hpp"

#include <vector>

namespace trussmap {

struct DescentOptions {
  int max_iterations = 200;
  double tolerance = 1e-13;  ///< relative decrease of chi^2 that a next step may still promise
};

struct Descent {
  std::vector<Pose> estimates;
  double chi2 = 0.0;
  int iterations = 0;          ///< steps taken
  double gradient_norm = 0.0;  ///< 2-norm of the gradient of chi^2
  bool converged = false;
};

/// Gauss-Newton with Levenberg-Marquardt damping when a step does not lower chi^2.
[[nodiscard]] Descent descend(PoseGraphSystem& system, std::vector<Pose> start,
                              const DescentOptions& options);

/// Positions by the one linear solve that the headings leave.
[[nodiscard]] std::vector<Pose> fit_positions(PoseGraphSystem& system,
                                              const std::vector<Pose>& estimates);

/// Vertices that can move without changing any measurement, most mobile first; none if all is
/// determined. Looks for a direction that strains no bar: a chain may be slender, not loose.
[[nodiscard]] std::vector<int> find_loose_vertices(PoseGraphSystem& system,
                                                   const std::vector<Pose>& estimates);

}  // namespace trussmap
