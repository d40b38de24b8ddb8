// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/dense.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace trussmap::linalg {

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(A);
  return {modes.eigenvalues(), modes.eigenvectors()};
}

PlanarModes planar_modes(const Matrix2& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix2> modes(A);
  return {modes.eigenvalues(), modes.eigenvectors()};
}

Vector2 symmetric_eigenvalues(const Matrix2& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix2>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::Vector3d symmetric_eigenvalues(const Matrix3& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

DenseCholesky::DenseCholesky(const Eigen::MatrixXd& A) : factor_(A) {}

Eigen::MatrixXd DenseCholesky::solve(const Eigen::MatrixXd& b) const {
  return factor_.solve(b);
}

double DenseCholesky::least_pivot_share() const {
  const Eigen::MatrixXd L = factor_.matrixL();
  double least = 1.0;
  for (Eigen::Index k = 0; k < L.rows(); ++k) {
    least = std::min(least, L(k, k) * L(k, k) / L.row(k).squaredNorm());
  }
  return least;
}

Eigen::VectorXd DenseCholesky::solve_half(const Eigen::VectorXd& b) const {
  return factor_.matrixU().solve(b);
}

Eigen::MatrixXd DenseCholesky::inverse() const {
  return factor_.solve(Eigen::MatrixXd::Identity(factor_.rows(), factor_.cols()));
}

Eigen::MatrixXd DenseCholesky::inverse_factor() const {
  return factor_.matrixL().solve(Eigen::MatrixXd::Identity(factor_.rows(), factor_.cols()));
}

double DenseCholesky::log_determinant() const {
  return 2.0 * factor_.matrixLLT().diagonal().array().log().sum();
}

DenseLdlt::DenseLdlt(const Eigen::MatrixXd& A) : factor_(A) {}

Eigen::VectorXd DenseLdlt::solve(const Eigen::VectorXd& b) const {
  return factor_.solve(b);
}

Eigen::MatrixXd DenseLdlt::inverse() const {
  return factor_.solve(Eigen::MatrixXd::Identity(factor_.rows(), factor_.cols()));
}

double DenseLdlt::log_determinant() const {
  return factor_.vectorD().array().abs().log().sum();
}

void append_columns(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& more) {
  matrix.conservativeResize(more.rows(), matrix.cols() + more.cols());
  matrix.rightCols(more.cols()) = more;
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns, std::optional<double> threshold) {
  if (columns.cols() == 0) return columns;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(columns.rows(), columns.cols());
  if (threshold) factor.setThreshold(*threshold);
  factor.compute(columns);
  return factor.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), factor.rank());
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
}

}  // namespace trussmap::linalg
