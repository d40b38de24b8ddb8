// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_projection.hpp"

#include "linalg/dense.hpp"

namespace trussmap {

FitProjection::FitProjection(const FitState& fit, const RecordingProblem& problem,
                             const RecordingSystem& system, const Eigen::MatrixXd& nuisance)
    : problem_(problem),
      system_(system),
      inverse_(system.normal_equations().matrix()),
      left_out_(problem.measurements.size(), false) {
  for (const int k : fit.adjustment.left_out) left_out_[idx(k)] = true;
  const Eigen::VectorXd offsets = offsets_of(fit);
  J_.reserve(problem.measurements.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    NodeRows rows;
    if (!left_out_[k]) {
      const MeasurementRows plain = measurement_rows(problem, one, fit.adjustment.state, one.value,
                                                     view_of(fit.columns.border, offsets, one));
      rows = {one.whitener * plain.by_from, one.whitener * plain.by_to};
    }
    if (system.gauge().hold_heading && one.from == problem.pose_node(0)) {
      rows.from.col(2).setZero();
    }
    J_.push_back(rows);
  }
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
  const NodeRows& J = J_[measurement];
  const BlockSystem& normal = system_.normal_equations();
  const int from = normal.size(one.from);
  const int to = one.to < 0 ? 0 : normal.size(one.to);
  const auto part = [&](int a, int a_size, int b, int b_size) -> Eigen::MatrixXd {
    if (a_size == 0 || b_size == 0) return Eigen::MatrixXd::Zero(a_size, b_size);
    return inverse_.block(normal.offset(a), a_size, normal.offset(b), b_size);
  };
  Eigen::MatrixXd N(from + to, from + to);
  N.topLeftCorner(from, from) = part(one.from, from, one.from, from);
  N.bottomRightCorner(to, to) = part(one.to, to, one.to, to);
  N.topRightCorner(from, to) = part(one.from, from, one.to, to);
  N.bottomLeftCorner(to, from) = N.topRightCorner(from, to).transpose();
  Eigen::MatrixXd rows(one.rows, from + to);
  rows.leftCols(from) = J.from.topLeftCorner(one.rows, from);
  rows.rightCols(to) = J.to.topLeftCorner(one.rows, to);
  Eigen::MatrixXd own = Eigen::MatrixXd::Identity(one.rows, one.rows);
  if (left_out_[measurement]) return own;
  own -= rows * N * rows.transpose();
  const auto Q = Q_.middleRows(system_.first_row(measurement), one.rows);
  own -= Q * Q.transpose();
  return 0.5 * (own + own.transpose());
}

}  // namespace trussmap
