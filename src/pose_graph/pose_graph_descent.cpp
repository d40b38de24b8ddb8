// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_descent.hpp"

#include "linalg/loose_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap {
namespace {

/// Largest coordinate or heading, at least 1: what rounding is relative to.
double scale_of(const std::vector<Pose>& estimates) {
  double scale = 1.0;
  for (const Pose& pose : estimates) {
    scale = std::max({scale, std::abs(pose.x), std::abs(pose.y), std::abs(pose.heading)});
  }
  return scale;
}

/// A pose graph as levenberg_marquardt wants it.
struct Problem {
  using State = std::vector<Pose>;
  using Step = Eigen::VectorXd;

  PoseGraphSystem& system;

  double linearise(const State& state) { return system.linearise(state); }
  Step solve_step(double damping) { return system.solve_step(damping); }
  double predicted(const Step& step, double damping) {
    double decrease = -step.dot(system.gradient());
    if (damping > 0.0) {
      decrease += damping * step.cwiseAbs2().dot(system.normal_equations().diagonal());
    }
    return decrease;
  }
  State moved(const State& state, const Step& step) { return system.moved(state, step); }
  State relaxed(const State& state) {
    system.linearise(state, true);
    double damping = 0.0;
    return system.moved(state, solve_damped(*this, damping));
  }
  static bool rounding(const State& state, const Step& step) {
    constexpr double kRounding = 1e-15;
    return step.size() == 0 || step.cwiseAbs().maxCoeff() <= kRounding * scale_of(state);
  }
};

}  // namespace

Descent descend(PoseGraphSystem& system, std::vector<Pose> start, const DescentOptions& options) {
  Problem problem{system};
  auto [estimates, chi2, iterations, converged] =
      levenberg_marquardt(problem, std::move(start), options);
  return {std::move(estimates), chi2, iterations, 2.0 * system.gradient().norm(), converged};
}

std::vector<Pose> fit_positions(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  return Problem{system}.relaxed(estimates);
}

std::vector<int> find_loose_vertices(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  constexpr LooseLimits kLimits{.strain = 1e-19, .stiffness = 1e-9};
  system.linearise(estimates);
  const auto strain = [&](const Eigen::VectorXd& mode) {
    return system.strain_energy(estimates, mode);
  };
  return find_loose_nodes(system.normal_equations(), strain, kLimits);
}

}  // namespace trussmap
