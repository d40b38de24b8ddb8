// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Eigen's decompositions of small dense matrices, compiled once: each costs seconds of a build in
// every source that instantiates it.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>

#include <Eigen/Cholesky>

namespace trussmap::linalg {

/// A = V diag(l) V' of a symmetric matrix, of which the lower triangle is read; l ascends.
struct SymmetricModes {
  Eigen::VectorXd eigenvalues;   ///< l
  Eigen::MatrixXd eigenvectors;  ///< V, a column each
};
[[nodiscard]] SymmetricModes symmetric_modes(const Eigen::MatrixXd& A);

/// The same of the plane: the axes of an ellipse.
struct PlanarModes {
  Vector2 eigenvalues;
  Matrix2 eigenvectors;
};
[[nodiscard]] PlanarModes planar_modes(const Matrix2& A);

/// l alone.
[[nodiscard]] Vector2 symmetric_eigenvalues(const Matrix2& A);
[[nodiscard]] Eigen::Vector3d symmetric_eigenvalues(const Matrix3& A);

/// A = L L'.
class DenseCholesky {
 public:
  explicit DenseCholesky(const Eigen::MatrixXd& A);

  [[nodiscard]] bool positive_definite() const { return factor_.info() == Eigen::Success; }
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;       ///< A^-1 b
  [[nodiscard]] Eigen::VectorXd solve_half(const Eigen::VectorXd& b) const;  ///< L^-T b
  [[nodiscard]] Eigen::MatrixXd inverse() const;                             ///< A^-1
  [[nodiscard]] Eigen::MatrixXd inverse_factor() const;                      ///< L^-1
  [[nodiscard]] double log_determinant() const;                              ///< of A
  /// Least L(i,i)^2/A(i,i): what an unknown keeps of its own where those before it are free. 1:
  /// all are independent; 0, but for rounding: A is singular.
  [[nodiscard]] double least_pivot_share() const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// P A P' = L D L', of a symmetric A that is semidefinite to rounding.
class DenseLdlt {
 public:
  explicit DenseLdlt(const Eigen::MatrixXd& A);

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  [[nodiscard]] double log_determinant() const;  ///< of |A|

 private:
  Eigen::LDLT<Eigen::MatrixXd> factor_;
};

/// Columns to the right of those that there are (none, perhaps of no rows either).
void append_columns(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& more);

/// An orthonormal basis of the columns' span. Columns whose pivot is less than `threshold` of the
/// largest count as combinations of the others; by default that is rounding alone.
[[nodiscard]] Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns,
                                                std::optional<double> threshold = std::nullopt);

/// The shortest x of those that bring A x nearest to b.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace trussmap::linalg
