// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/restricted_likelihood.hpp"

#include "linalg/dense.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

/// Added to what the sum is already.
double plus_log_variances(double sum, const RecordingSystem& system,
                          const RecordingProblem& problem) {
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    if (system.root_weight(k) == 0.0) continue;
    const Measurement& one = problem.measurements[k];
    sum -= 2.0 * one.whitener.diagonal().head(one.rows).array().log().sum();
  }
  for (const NoiseState& state : problem.noise_states) sum += 2.0 * std::log(state.sd);
  return sum;
}

/// What is left of columns when the unknowns have taken their part: N' (S^-1 - ...) N, N whitened.
Eigen::MatrixXd information_of(const RecordingSystem& system, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd& M = system.border();
  const Eigen::Index nodes = system.normal_equations().unknowns();
  Eigen::MatrixXd right(nodes + M.cols(), columns.cols());
  right.topRows(nodes) = system.transposed_times(columns);
  right.bottomRows(M.cols()) = M.transpose() * columns;
  return columns.transpose() * columns - right.transpose() * system.solve(right);
}

}  // namespace

double log_determinants(const RecordingSystem& system, const RecordingProblem& problem) {
  return plus_log_variances(0.0, system, problem) + system.log_determinant();
}

RestrictedLikelihood restricted_likelihood(RecordingSystem& system, const RecordingProblem& problem,
                                           const RecordingState& state,
                                           const Eigen::VectorXd& coefficients,
                                           const Eigen::MatrixXd& columns, double elsewhere) {
  const double chi2 = system.linearise(state, coefficients);
  const RecordingSystem::Step step = system.solve_step();
  RestrictedLikelihood result;
  result.without = plus_log_variances(elsewhere, system, problem);
  result.without += system.log_determinant() + chi2 - step.predicted;
  if (columns.cols() == 0) return result;
  Eigen::VectorXd left = system.residuals() + system.times(step.nodes);
  if (step.coefficients.size() > 0) left += system.border() * step.coefficients;
  const Eigen::VectorXd g = columns.transpose() * left;
  const linalg::DenseLdlt factor(information_of(system, columns));
  result.taken = g.dot(factor.solve(g));
  result.information = factor.log_determinant();
  return result;
}

}  // namespace trussmap::estimation
