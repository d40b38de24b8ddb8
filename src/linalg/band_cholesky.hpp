// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Cholesky factorisation of a small symmetric positive definite matrix whose entries lie near its
// diagonal: A = L L', both kept as columns of `band` + 1 entries. Cost: n band^2.
//
// Small enough that no library's call pays: some hundred unknowns, thousands of times a second.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace trussmap::linalg {

class BandMatrix {
 public:
  /// n x n, zero; entries farther than `band` from the diagonal cannot be set.
  void resize(int n, int band);

  [[nodiscard]] int size() const { return n_; }
  /// row >= column, row - column <= band.
  [[nodiscard]] double& at(int row, int column) { return column_begin(column)[row - column]; }
  void add(int row, int column, double value) { at(row, column) += value; }

  /// A becomes L. Where a pivot is below `least` times its diagonal entry, the unknown is held: its
  /// row and column become those of the identity, and a right-hand side has 0 there.
  void factorise(double least);
  /// L L' x = b; `x` holds b before and the solution after.
  void solve_in_place(Eigen::VectorXd& x) const;

 private:
  [[nodiscard]] double* column_begin(int column) {
    return values_.data() + static_cast<std::size_t>(column) * stride_;
  }
  [[nodiscard]] const double* column_begin(int column) const {
    return values_.data() + static_cast<std::size_t>(column) * stride_;
  }

  int n_ = 0;
  int band_ = 0;
  std::size_t stride_ = 1;
  std::vector<double> values_;
  std::vector<char> held_;
};

}  // namespace trussmap::linalg
