// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sparse Cholesky factorisation of a symmetric positive definite matrix (CHOLMOD behind it).
//
//   A   n x n, of which only the LOWER triangle is read
//   L   its factor under a fill-reducing permutation
//
// analyse once per structure, factorise for every set of values, solve as often as wanted. A live
// factor can be changed by a low-rank update, A + W W', or grow by a row, without factorising anew.
//
// Not copyable; one object is used by one thread at a time, different objects by any threads.
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include <Eigen/SparseCore>

namespace trussmap::linalg {

/// Column-major, int indices: CHOLMOD's own layout.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// `fixed` is `natural` to the letter: not even columns that could as well change places do, so
/// that those of rows to be added stay last.
enum class Ordering { automatic, amd, metis, natural, fixed };

/// Thrown by factorise: the matrix is not positive definite. `column` is that of A at which the
/// factorisation broke down.
class NotPositiveDefinite : public std::runtime_error {
 public:
  explicit NotPositiveDefinite(int column)
      : std::runtime_error(
            "the problem has no unique solution in numbers (its matrix is not positive definite): "
            "sizes may be wrong by powers of ten, a column in another unit or a noise far "
            "too small"),
        column_(column) {}
  [[nodiscard]] int column() const { return column_; }

 private:
  int column_;
};

class SparseCholesky {
 public:
  explicit SparseCholesky(Ordering ordering = Ordering::automatic);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Ordering and symbolic factorisation for this pattern (values are ignored).
  void analyse(const SparseMatrix& lower);

  /// Numerical factorisation; the pattern must be the one analysed. Throws NotPositiveDefinite.
  void factorise(const SparseMatrix& lower);

  /// A x = b for each column of b. Call after factorise.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// The same without allocating: `x` holds b before and the solution after.
  void solve_in_place(Eigen::VectorXd& x);

  /// The fill-reducing order of the structure analysed: place k of the factor is column [k] of A.
  [[nodiscard]] std::vector<int> order() const;

  /// Multiplications that a factorisation of that structure takes.
  [[nodiscard]] double multiplications() const;

  /// Makes the factor that of A + W W' (n x k, few columns). The factor becomes simplicial LDL'.
  void update(const SparseMatrix& w);

  /// The same for A - W W', which must be positive definite still.
  void downdate(const SparseMatrix& w);

  /// Row and column `row` of A, until now those of the identity, become `column` (n x 1, its
  /// diagonal entry included), with which A must be positive definite.
  void add_row(int row, const SparseMatrix& column);

  /// A x = b for a b that is mostly zero, by the kind of factor that updates leave (which it is
  /// made if need be); `x` holds b before and the solution after. Cost: half of solve's.
  void solve_updated(Eigen::VectorXd& x);

  /// Natural logarithm of the determinant of A. Call after factorise.
  [[nodiscard]] double log_determinant() const;

  /// Reciprocal of a rough condition number, (min L_ii / max L_ii)^2.
  [[nodiscard]] double reciprocal_condition() const;

  /// The least share that elimination has left of a diagonal entry of A: of its 16 digits so many
  /// are lost as the share has zeros behind the point. Unlike a condition it does not depend on
  /// the unknowns' units. `diagonal`: of A.
  [[nodiscard]] double least_pivot_share(const Eigen::VectorXd& diagonal) const;

  /// Nonzeros of L as stored.
  [[nodiscard]] double factor_nonzeros() const;

 private:
  void change(bool add, const SparseMatrix& w);
  /// D of A = L D L' with unit diagonal, in the factor's order.
  [[nodiscard]] std::vector<double> pivots() const;

  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace trussmap::linalg
