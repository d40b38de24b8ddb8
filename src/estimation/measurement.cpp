// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement.hpp"

#include "linalg/dense.hpp"

#include <Eigen/LU>

namespace trussmap::estimation {

Matrix4 whitener_of(const Matrix4& covariance, int rows) {
  Matrix4 result = Matrix4::Zero();
  const Eigen::MatrixXd block = covariance.topLeftCorner(rows, rows);
  result.topLeftCorner(rows, rows) = linalg::DenseCholesky(block).inverse_factor();
  return result;
}

Matrix4 whitener_with(const Matrix4& whitener, const Matrix4& more, int rows) {
  if (more.isZero(0.0)) return whitener;
  Matrix4 colour = Matrix4::Zero();
  colour.topLeftCorner(rows, rows) = whitener.topLeftCorner(rows, rows).inverse();
  return whitener_of(colour * colour.transpose() + more, rows);
}

Eigen::MatrixXd covariance_of(const Measurement& one) {
  const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
  return (W.transpose() * W).inverse();
}

}  // namespace trussmap::estimation
