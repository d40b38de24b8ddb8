// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_robust.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

/// Weight of the truncated square bent by mu (Yang et al., eq. 14).
double bent_weight(double squared_error, double gate, double mu) {
  if (squared_error <= mu / (mu + 1.0) * gate) return 1.0;
  if (squared_error >= (mu + 1.0) / mu * gate) return 0.0;
  return std::sqrt(gate * mu * (mu + 1.0) / squared_error) - mu;
}

/// A landmark without any sighting would be tied to nothing.
void keep_one_per_landmark(const RecordingProblem& problem,
                           const std::vector<double>& squared_errors,
                           std::vector<double>& weights) {
  std::vector<std::size_t> best(problem.landmarks.size(), problem.measurements.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!is_sighting(one.kind)) continue;
    std::size_t& chosen = best[idx(one.to)];
    if (chosen == problem.measurements.size() || squared_errors[k] < squared_errors[chosen]) {
      chosen = k;
    }
  }
  constexpr double kLeast = 1e-3;
  for (const std::size_t k : best) {
    if (k < weights.size()) weights[k] = std::max(weights[k], kLeast);
  }
}

}  // namespace

std::vector<double> soft_weights(const RecordingProblem& problem,
                                 const std::vector<double>& squared_errors, double gate) {
  std::vector<double> weights(squared_errors.size(), 1.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!is_sighting(problem.measurements[k].kind)) continue;
    weights[k] = std::pow(gate / (squared_errors[k] + gate), 2);
  }
  return weights;
}

RobustFit reduce_nonconvexity(RecordingSystem& system, const RecordingProblem& problem,
                              RecordingState state, Eigen::VectorXd coefficients, double gate) {
  constexpr double kBendFaster = 1.4;
  constexpr double kNearlyTruncated = 1e3;
  constexpr int kSteps = 2;  // of descent per bend
  RobustFit fit{std::move(state), std::move(coefficients), {}};
  fit.weights.assign(problem.measurements.size(), 1.0);
  system.set_weights(fit.weights);  // those that led to the start were soft
  system.linearise(fit.state, fit.coefficients);
  double largest = 0.0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    if (is_sighting(problem.measurements[k].kind)) {
      largest = std::max(largest, system.squared_errors()[k]);
    }
  }
  if (largest <= gate) return fit;
  const auto weigh = [&](double mu) {
    for (std::size_t k = 0; k < fit.weights.size(); ++k) {
      if (!is_sighting(problem.measurements[k].kind)) continue;
      fit.weights[k] = bent_weight(system.squared_errors()[k], gate, mu);
    }
    keep_one_per_landmark(problem, system.squared_errors(), fit.weights);
    system.set_weights(fit.weights);
  };
  double mu = gate / (2.0 * largest - gate);
  while (mu < kNearlyTruncated) {
    weigh(mu);
    RecordingDescent next =
        descend(system, fit.state, fit.coefficients, {kSteps, 1e-6, kNegligibleDecrease});
    fit.state = std::move(next.state);
    fit.coefficients = std::move(next.coefficients);
    mu *= kBendFaster;
  }
  weigh(1e9);  // in or out
  for (double& weight : fit.weights) weight = weight > 0.0 ? 1.0 : 0.0;
  system.set_weights(fit.weights);
  return fit;
}

}  // namespace trussmap
