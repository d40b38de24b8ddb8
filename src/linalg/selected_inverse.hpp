// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The inverse of a sparse matrix where its Cholesky factor has entries: variances of all unknowns,
// and covariances of all that a measurement joins, for about the price of one factorisation.
//
//   A = L D L',  Z = A^-1;   A in an order that keeps L sparse
//
//   Z_ij = -sum Z_ik L_kj                       i > j, over the k > j with L_kj != 0
//   Z_jj = 1/d_j - sum Z_jk L_kj
//
// Columns are found from the last to the first, and all Z_ik asked for are where L has entries
// (Takahashi, Fagan & Chin, "Formation of a sparse bus impedance matrix and its application to
// short circuit study", 1973).
#pragma once

#include "linalg/sparse_cholesky.hpp"

namespace trussmap::linalg {

class SelectedInverse {
 public:
  /// Of the matrix with this lower triangle, no unknown moved. Throws NotPositiveDefinite.
  explicit SelectedInverse(const SparseMatrix& lower);

  /// Entry of A^-1; it must be where L has one, as all entries of A are.
  [[nodiscard]] double operator()(int row, int column) const;
  /// rows x columns of them, from (row, column) on.
  [[nodiscard]] Eigen::MatrixXd block(int row, int rows, int column, int columns) const;

 private:
  SparseMatrix below_;  ///< strictly below the diagonal
  Eigen::VectorXd diagonal_;
};

}  // namespace trussmap::linalg
