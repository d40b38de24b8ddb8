// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_projection.hpp"

#include "linalg/dense.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr Eigen::Index kColumns = 16;  // worked on at once

}  // namespace

FitProjection::FitProjection(const FitState& fit, const estimation::RecordingProblem& problem,
                             const estimation::RecordingSystem& system,
                             const Eigen::MatrixXd& nuisance,
                             std::shared_ptr<const estimation::FittedRows> fitted)
    : problem_(problem),
      system_(system),
      fitted_(fitted ? std::move(fitted) : std::make_shared<const estimation::FittedRows>(system)),
      left_out_(problem.measurements.size(), false) {
  for (const int k : fit.adjustment.left_out) left_out_[idx(k)] = true;
  const Eigen::MatrixXd& M = system.border();
  Eigen::MatrixXd columns(system.rows(), M.cols() + nuisance.cols());
  columns.leftCols(M.cols()) = M;
  columns.rightCols(nuisance.cols()) = nuisance;
  Q_ = system.free_of_nodes(std::move(columns));
  if (Q_.cols() > 0) {
    // Each with the same say in what depends on what.
    for (Eigen::Index c = 0; c < Q_.cols(); ++c) {
      if (Q_.col(c).norm() > 0.0) Q_.col(c).normalize();
    }
    Q_ = linalg::orthonormal_basis(Q_, kSameDirection);
  }
}

Eigen::MatrixXd FitProjection::times(Eigen::MatrixXd columns) const {
  for (Eigen::Index first = 0; first < columns.cols(); first += kColumns) {
    auto some = columns.middleCols(first, std::min(kColumns, columns.cols() - first));
    Eigen::MatrixXd left = system_.free_of_nodes(some);
    if (Q_.cols() > 0) left -= Q_ * (Q_.transpose() * left);
    some = left;
  }
  return columns;
}

Eigen::MatrixXd FitProjection::own_block(std::size_t measurement) const {
  const estimation::Measurement& one = problem_.measurements[measurement];
  Eigen::MatrixXd own = Eigen::MatrixXd::Identity(one.rows, one.rows);
  if (left_out_[measurement]) return own;
  own -= fitted_->by_nodes(system_, measurement);
  const auto Q = Q_.middleRows(system_.first_row(measurement), one.rows);
  own -= Q * Q.transpose();
  return 0.5 * (own + own.transpose());
}

}  // namespace trussmap::fitting
