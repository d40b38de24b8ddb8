// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_descent.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>

namespace trussmap {
namespace {

constexpr double kFirstDamping = 1e-4;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e12;
constexpr double kPoor = 0.25;         // of the promised decrease
constexpr double kNegligible = 1e-10;  // of chi^2, where it is all but zero

RecordingSystem::Step solve_damped(RecordingSystem& system, double& damping) {
  for (;;) {
    try {
      return system.solve_step(damping);
    } catch (const NotPositiveDefinite&) {
      if (damping >= kMostDamping) throw;
      damping = std::max(kFirstDamping, 10.0 * damping);
    }
  }
}

}  // namespace

RecordingDescent descend(RecordingSystem& system, RecordingState state,
                         Eigen::VectorXd coefficients, const RecordingDescentOptions& options) {
  RecordingDescent result{std::move(state), std::move(coefficients), 0.0, 0, false};
  result.chi2 = system.linearise(result.state, result.coefficients);
  double damping = 0.0;
  bool last = false;
  while (!last && result.iterations < options.max_iterations) {
    const RecordingSystem::Step step = solve_damped(system, damping);
    const double enough = options.tolerance * result.chi2 + kNegligible;
    last = damping == 0.0 && step.predicted <= enough;
    RecordingState next = system.moved(result.state, step);
    Eigen::VectorXd next_coefficients = result.coefficients + step.coefficients;
    double chi2 = system.linearise(next, next_coefficients);
    if (!last && result.chi2 - chi2 < kPoor * step.predicted) {
      // Turning a stiff part by a finite angle strains it, to second order in the angle. The
      // positions that suit the new headings best take that strain out.
      system.linearise(next, next_coefficients, true);
      double undamped = 0.0;
      next = system.moved(next, solve_damped(system, undamped));
      chi2 = system.linearise(next, next_coefficients);
    }
    const double decrease = result.chi2 - chi2;
    if (decrease >= 0.0) {
      result.state = std::move(next);
      result.coefficients = std::move(next_coefficients);
      result.chi2 = chi2;
      ++result.iterations;
      if (decrease > 0.5 * step.predicted) {
        damping = damping > 10.0 * kLeastDamping ? damping / 10.0 : 0.0;
      } else if (decrease < kPoor * step.predicted) {
        damping = std::max(kFirstDamping, 10.0 * damping);
      }
    } else {
      system.linearise(result.state, result.coefficients);
      // A step that promises next to nothing and gains nothing: this is the bottom, to rounding.
      if (step.predicted <= 1e-9 * result.chi2 + kNegligible) last = true;
      if (damping >= kMostDamping) break;
      damping = std::max(kFirstDamping, 10.0 * damping);
    }
    result.converged = last;
  }
  return result;
}

std::vector<int> find_loose_nodes(RecordingSystem& system, const RecordingProblem& problem) {
  constexpr double kSafeCondition = 1e-13;  // no doubt above
  constexpr double kLoose = 1e-17;          // energy of a mode that only rounding strains
  constexpr double kShare = 1e-3;           // of the largest motion, to be worth naming
  BlockSystem& A = system.normal_equations();
  if (A.unknowns() == 0) return {};
  const Eigen::VectorXd diagonal = A.diagonal();
  try {
    A.factorise();
    if (A.reciprocal_condition() > kSafeCondition) return {};
  } catch (const NotPositiveDefinite&) {
    const double floor = 1e-30 * diagonal.maxCoeff();
    A.set_diagonal((1.0 + 1e-13) * diagonal + Eigen::VectorXd::Constant(diagonal.size(), floor));
    A.factorise();
    A.set_diagonal(diagonal);
  }
  // Inverse iteration towards the softest mode, each unknown measured by its own stiffness.
  const Eigen::VectorXd stiffness = diagonal.cwiseMax(1e-12 * diagonal.maxCoeff());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd mode(A.unknowns());
  for (double& entry : mode) entry = uniform(random);
  for (int round = 0; round < 4; ++round) {
    mode = stiffness.cwiseProduct(mode);
    A.solve_in_place(mode);
    mode /= std::sqrt(mode.cwiseAbs2().dot(stiffness));
  }
  if (system.times(mode).squaredNorm() > kLoose) return {};

  std::vector<std::pair<double, int>> moves;
  for (int node = 0; node < problem.nodes(); ++node) {
    double most = 0.0;
    for (int k = 0; k < A.size(node); ++k) {
      const int at = A.offset(node) + k;
      most = std::max(most, std::abs(mode[at]) * std::sqrt(stiffness[at]));
    }
    moves.emplace_back(most, node);
  }
  std::stable_sort(moves.begin(), moves.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<int> loose;
  for (const auto& [most, node] : moves) {
    if (most > kShare * moves.front().first) loose.push_back(node);
  }
  return loose;
}

std::vector<int> find_undetermined(const RecordingSystem& system) {
  constexpr double kFree = 1e-9;  // of what the coefficient's own rows would tell
  constexpr double kShare = 0.1;  // of the eigenvector, to be worth naming
  const Eigen::MatrixXd schur = system.scaled_schur();
  if (schur.cols() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(schur);
  std::vector<int> result;
  for (Eigen::Index c = 0; c < schur.cols(); ++c) {
    double share = 0.0;
    for (Eigen::Index k = 0; k < schur.cols(); ++k) {
      if (modes.eigenvalues()[k] < kFree) {
        share = std::max(share, std::abs(modes.eigenvectors()(c, k)));
      }
    }
    if (share > kShare) result.push_back(static_cast<int>(c));
  }
  return result;
}

}  // namespace trussmap
