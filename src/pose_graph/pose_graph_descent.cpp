// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_descent.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace trussmap {
namespace {

constexpr double kFirstDamping = 1e-4;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e12;

/// Largest coordinate or heading, at least 1: what rounding is relative to.
double scale_of(const std::vector<Pose>& estimates) {
  double scale = 1.0;
  for (const Pose& pose : estimates) {
    scale = std::max({scale, std::abs(pose.x), std::abs(pose.y), std::abs(pose.heading)});
  }
  return scale;
}

/// The step for the first damping from `damping` on with which the system can be solved.
const Eigen::VectorXd& solve_damped(PoseGraphSystem& system, double& damping) {
  for (;;) {
    try {
      return system.solve_step(damping);
    } catch (const NotPositiveDefinite&) {
      if (damping >= kMostDamping) throw;
      damping = std::max(kFirstDamping, 10.0 * damping);
    }
  }
}

/// What the quadratic model says the step takes off chi^2.
double promised_decrease(PoseGraphSystem& system, const Eigen::VectorXd& step, double damping) {
  double decrease = -step.dot(system.gradient());
  if (damping > 0.0) {
    decrease += damping * step.cwiseAbs2().dot(system.normal_equations().diagonal());
  }
  return decrease;
}

}  // namespace

Descent descend(PoseGraphSystem& system, std::vector<Pose> start, const DescentOptions& options) {
  constexpr double kRoundingStep = 1e-15;
  constexpr double kPoor = 0.25;  // of the promised decrease
  Descent result;
  result.estimates = std::move(start);
  result.chi2 = system.linearise(result.estimates);
  double damping = 0.0;
  bool last = false;
  while (!last && result.iterations < options.max_iterations) {
    const Eigen::VectorXd step = solve_damped(system, damping);
    const double predicted = promised_decrease(system, step, damping);
    const double size = step.size() == 0 ? 0.0 : step.cwiseAbs().maxCoeff();
    const bool negligible = size <= kRoundingStep * scale_of(result.estimates);
    if (negligible && damping == 0.0) {
      result.converged = true;
      break;
    }
    last = damping == 0.0 && predicted <= options.tolerance * result.chi2;
    std::vector<Pose> next = system.moved(result.estimates, step);
    double chi2 = system.linearise(next);
    if (!last && result.chi2 - chi2 < kPoor * predicted) {
      // Turning a stiff part by a finite angle strains it, to second order in the angle. The
      // positions that suit the new headings best take that strain out.
      next = fit_positions(system, next);
      chi2 = system.linearise(next);
    }
    const double decrease = result.chi2 - chi2;
    if (decrease >= 0.0) {
      result.estimates = std::move(next);
      result.chi2 = chi2;
      ++result.iterations;
      if (decrease > 0.5 * predicted)
        damping = damping > 10.0 * kLeastDamping ? damping / 10.0 : 0.0;
    } else {
      system.linearise(result.estimates);
      // A model that is exact to rounding and a step that gains nothing: this is the bottom.
      if (negligible || (predicted <= 1e-10 * result.chi2 && damping == 0.0)) last = true;
      if (damping >= kMostDamping) break;
      damping = std::max(kFirstDamping, 10.0 * damping);
    }
    result.converged = last;
  }
  result.gradient_norm = 2.0 * system.gradient().norm();
  return result;
}

std::vector<Pose> fit_positions(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  system.linearise(estimates, true);
  double damping = 0.0;
  return system.moved(estimates, solve_damped(system, damping));
}

std::vector<int> find_loose_vertices(PoseGraphSystem& system, const std::vector<Pose>& estimates) {
  constexpr double kSafeCondition = 1e-13;  // no doubt above
  constexpr double kLoose = 1e-19;          // energy of a mode that only rounding strains
  constexpr double kShare = 1e-3;           // of the largest motion, to be worth naming
  BlockSystem& H = system.normal_equations();
  if (H.unknowns() == 0) return {};
  system.linearise(estimates);
  try {
    H.factorise();
    if (H.reciprocal_condition() > kSafeCondition) return {};
  } catch (const NotPositiveDefinite&) {
    const Eigen::VectorXd diagonal = H.diagonal();
    const double floor = 1e-30 * diagonal.maxCoeff();
    H.set_diagonal((1.0 + 1e-13) * diagonal + Eigen::VectorXd::Constant(diagonal.size(), floor));
    H.factorise();
    H.set_diagonal(diagonal);
  }
  // Inverse iteration towards the softest mode, each unknown measured by its own stiffness.
  const Eigen::VectorXd diagonal = H.diagonal();
  const Eigen::VectorXd stiffness = diagonal.cwiseMax(1e-9 * diagonal.maxCoeff());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd mode(H.unknowns());
  for (double& entry : mode) entry = uniform(random);
  for (int round = 0; round < 4; ++round) {
    mode = stiffness.cwiseProduct(mode);
    H.solve_in_place(mode);
    mode /= std::sqrt(mode.cwiseAbs2().dot(stiffness));
  }
  if (system.strain_energy(estimates, mode) > kLoose) return {};

  std::vector<double> moves(estimates.size(), 0.0);
  for (int k = 0; k < H.unknowns(); ++k) {
    double& most = moves[idx(system.vertex_of(k))];
    most = std::max(most, std::abs(mode[k]) * std::sqrt(stiffness[k]));
  }
  const double largest = *std::max_element(moves.begin(), moves.end());
  std::vector<int> loose;
  for (std::size_t v = 0; v < moves.size(); ++v) {
    if (moves[v] > kShare * largest) loose.push_back(static_cast<int>(v));
  }
  std::stable_sort(loose.begin(), loose.end(),
                   [&moves](int a, int b) { return moves[idx(a)] > moves[idx(b)]; });
  return loose;
}

}  // namespace trussmap
