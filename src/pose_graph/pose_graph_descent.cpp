// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_descent.hpp"

#include "geometry/largest_coordinate.hpp"
#include "linalg/damped_step.hpp"
#include "linalg/loose_nodes.hpp"

#include <utility>

namespace trussmap::pose_graph {
namespace {

/// A pose graph as levenberg_marquardt wants it.
struct Problem {
  using State = std::vector<Pose>;
  using Step = PoseGraphSystem::Step;

  PoseGraphSystem& system;

  double linearise(const State& state, bool hold_headings) {
    return system.linearise(state, hold_headings);
  }
  Step solve_step(double damping) { return system.solve_step(damping); }
  State moved(const State& state, const Step& step) { return system.moved(state, step.nodes); }
  State placed(const State& state, const Step& step) { return moved(state, step); }
  static bool rounding(const State& state, const Step& step) {
    return linalg::is_rounding(step.nodes, geometry::largest_coordinate(state));
  }
};

}  // namespace

Descent descend(PoseGraphSystem& system, std::vector<Pose> start,
                const linalg::DescentOptions& options) {
  Problem problem{system};
  auto [estimates, chi2, iterations, converged] =
      linalg::levenberg_marquardt(problem, std::move(start), options);
  return {std::move(estimates), chi2, iterations, 2.0 * system.gradient().norm(), converged};
}

std::vector<Pose> fit_positions(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  Problem problem{system};
  return linalg::relaxed(problem, estimates);
}

std::vector<int> find_loose_vertices(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  constexpr linalg::LooseLimits kLimits{.strain = 1e-19, .stiffness = 1e-9};
  system.linearise(estimates);
  const auto strain = [&](const Eigen::VectorXd& mode) {
    return system.strain_energy(estimates, mode);
  };
  return linalg::find_loose_nodes(system.normal_equations(), strain, kLimits);
}

}  // namespace trussmap::pose_graph
