// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/selected_inverse.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include <Eigen/SparseCholesky>

namespace trussmap::linalg {

SelectedInverse::SelectedInverse(const SparseMatrix& lower) {
  using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const Factor factor(lower);
  diagonal_ = factor.vectorD();
  for (Eigen::Index k = 0; k < diagonal_.size(); ++k) {
    if (factor.info() != Eigen::Success || !(diagonal_[k] > 0.0)) {
      throw NotPositiveDefinite(static_cast<int>(k));
    }
  }
  const SparseMatrix& L = factor.matrixL().nestedExpression();
  below_ = L;
  std::vector<int> place(static_cast<std::size_t>(L.rows()), -1);  // in the column at hand
  std::vector<double> sums;
  for (int j = static_cast<int>(L.cols()) - 1; j >= 0; --j) {
    const int first = L.outerIndexPtr()[j];
    const int count = L.outerIndexPtr()[j + 1] - first;
    const int* rows = L.innerIndexPtr() + first;
    const double* l = L.valuePtr() + first;
    for (int a = 0; a < count; ++a) place[static_cast<std::size_t>(rows[a])] = a;
    sums.assign(static_cast<std::size_t>(count), 0.0);
    for (int a = 0; a < count; ++a) {
      const int k = rows[a];
      double own = diagonal_[k] * l[a];
      for (int at = L.outerIndexPtr()[k]; at < L.outerIndexPtr()[k + 1]; ++at) {
        const int b = place[static_cast<std::size_t>(L.innerIndexPtr()[at])];
        if (b < 0) continue;
        const double z = below_.valuePtr()[at];
        sums[static_cast<std::size_t>(b)] += z * l[a];
        own += z * l[b];
      }
      sums[static_cast<std::size_t>(a)] += own;
    }
    diagonal_[j] = 1.0 / diagonal_[j];
    for (int a = 0; a < count; ++a) {
      const double sum = sums[static_cast<std::size_t>(a)];
      below_.valuePtr()[first + a] = -sum;
      diagonal_[j] += l[a] * sum;
      place[static_cast<std::size_t>(rows[a])] = -1;
    }
  }
}

double SelectedInverse::operator()(int row, int column) const {
  if (row == column) return diagonal_[row];
  if (row < column) std::swap(row, column);
  const int* begin = below_.innerIndexPtr() + below_.outerIndexPtr()[column];
  const int* end = below_.innerIndexPtr() + below_.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row && "the factor has no entry there");
  return below_.valuePtr()[found - below_.innerIndexPtr()];
}

Eigen::MatrixXd SelectedInverse::block(int row, int rows, int column, int columns) const {
  Eigen::MatrixXd result(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) result(i, j) = (*this)(row + i, column + j);
  }
  return result;
}

}  // namespace trussmap::linalg
