// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_projection.hpp"

#include "linalg/dense.hpp"

namespace trussmap {

FitProjection::FitProjection(const FitState& fit, const RecordingProblem& problem,
                             const RecordingSystem& system, const Eigen::MatrixXd& nuisance)
    : problem_(problem),
      system_(system),
      fitted_(system),
      left_out_(problem.measurements.size(), false) {
  for (const int k : fit.adjustment.left_out) left_out_[idx(k)] = true;
  const Eigen::MatrixXd& M = system.border();
  Eigen::MatrixXd columns(system.rows(), M.cols() + nuisance.cols());
  columns.leftCols(M.cols()) = M;
  columns.rightCols(nuisance.cols()) = nuisance;
  Q_ = columns;
  if (Q_.cols() > 0) {
    Q_ -= system.times(system.solve_nodes(system.transposed_times(columns)));
    // Each with the same say in what depends on what.
    for (Eigen::Index c = 0; c < Q_.cols(); ++c) {
      if (Q_.col(c).norm() > 0.0) Q_.col(c).normalize();
    }
    Q_ = orthonormal_basis(Q_, kSameDirection);
  }
}

Eigen::MatrixXd FitProjection::times(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd left =
      columns - system_.times(system_.solve_nodes(system_.transposed_times(columns)));
  if (Q_.cols() > 0) left -= Q_ * (Q_.transpose() * left);
  return left;
}

Eigen::MatrixXd FitProjection::own_block(std::size_t measurement) const {
  const Measurement& one = problem_.measurements[measurement];
  Eigen::MatrixXd own = Eigen::MatrixXd::Identity(one.rows, one.rows);
  if (left_out_[measurement]) return own;
  own -= fitted_.by_nodes(system_, measurement);
  const auto Q = Q_.middleRows(system_.first_row(measurement), one.rows);
  own -= Q * Q.transpose();
  return 0.5 * (own + own.transpose());
}

}  // namespace trussmap
