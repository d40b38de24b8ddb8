// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_descent.hpp"

#include "geometry/largest_coordinate.hpp"
#include "linalg/damped_step.hpp"
#include "linalg/dense.hpp"
#include "linalg/loose_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::estimation {
namespace {

/// A recording problem as levenberg_marquardt wants it.
struct Problem {
  struct State {
    RecordingState nodes;
    Eigen::VectorXd coefficients;
  };
  using Step = RecordingSystem::Step;

  RecordingSystem& system;

  double linearise(const State& state, bool hold_headings) {
    return system.linearise(state.nodes, state.coefficients, hold_headings);
  }
  Step solve_step(double damping) { return system.solve_step(damping); }
  State moved(const State& state, const Step& step) {
    return {system.moved(state.nodes, step), state.coefficients + step.coefficients};
  }
  State placed(const State& state, const Step& step) {
    return {system.moved(state.nodes, step), state.coefficients};
  }
  static bool rounding(const State& state, const Step& step) {
    const double size = std::max(geometry::largest_coordinate(state.nodes.landmarks),
                                 geometry::largest_coordinate(state.nodes.poses));
    return linalg::is_rounding(step.nodes, size) &&
           (step.coefficients.cwiseAbs().array() <=
            linalg::kRounding * state.coefficients.cwiseAbs().array())
               .all();
  }
};

}  // namespace

RecordingDescent descend(RecordingSystem& system, RecordingState state,
                         Eigen::VectorXd coefficients, const linalg::DescentOptions& options) {
  Problem problem{system};
  auto [end, chi2, iterations, converged] =
      linalg::levenberg_marquardt(problem, {std::move(state), std::move(coefficients)}, options);
  return {std::move(end.nodes), std::move(end.coefficients), chi2, iterations, converged};
}

std::vector<int> find_loose_nodes(RecordingSystem& system) {
  constexpr linalg::LooseLimits kLimits{.strain = 1e-17, .stiffness = 1e-12};
  const auto strain = [&system](const Eigen::VectorXd& mode) {
    return system.times(mode).squaredNorm();
  };
  return linalg::find_loose_nodes(system.normal_equations(), strain, kLimits);
}

std::vector<int> find_undetermined(const RecordingSystem& system) {
  constexpr double kFree = 1e-9;  // of what the coefficient's own rows would tell
  constexpr double kShare = 0.1;  // of the eigenvector, to be worth naming
  const Eigen::MatrixXd schur = system.scaled_schur();
  if (schur.cols() == 0) return {};
  const linalg::SymmetricModes modes = linalg::symmetric_modes(schur);
  std::vector<int> result;
  for (Eigen::Index c = 0; c < schur.cols(); ++c) {
    double share = 0.0;
    for (Eigen::Index k = 0; k < schur.cols(); ++k) {
      if (modes.eigenvalues[k] < kFree) {
        share = std::max(share, std::abs(modes.eigenvectors(c, k)));
      }
    }
    if (share > kShare) result.push_back(static_cast<int>(c));
  }
  return result;
}

}  // namespace trussmap::estimation
