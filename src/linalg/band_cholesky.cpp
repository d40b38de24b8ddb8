// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/band_cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::linalg {

void BandMatrix::resize(int n, int band) {
  n_ = n;
  band_ = std::min(band, std::max(n - 1, 0));
  stride_ = static_cast<std::size_t>(band_) + 1;
  values_.assign(static_cast<std::size_t>(n) * stride_, 0.0);
  held_.assign(static_cast<std::size_t>(n), 0);
}

void BandMatrix::factorise(double least) {
  std::vector<double> diagonal(static_cast<std::size_t>(n_));
  for (int j = 0; j < n_; ++j) diagonal[static_cast<std::size_t>(j)] = at(j, j);
  for (int j = 0; j < n_; ++j) {
    double* column = column_begin(j);
    const int below = std::min(band_, n_ - 1 - j);
    const double pivot = column[0];
    if (!(pivot > least * diagonal[static_cast<std::size_t>(j)]) || !(pivot > 0.0)) {
      std::fill_n(column, below + 1, 0.0);
      column[0] = 1.0;
      held_[static_cast<std::size_t>(j)] = 1;
      continue;
    }
    const double root = std::sqrt(pivot);
    column[0] = root;
    const double inverse = 1.0 / root;
    for (int k = 1; k <= below; ++k) column[k] *= inverse;
    for (int k = 1; k <= below; ++k) {
      const double factor = column[k];
      if (factor == 0.0) continue;
      double* target = column_begin(j + k);
      const double* source = column + k;
      for (int m = 0; m <= below - k; ++m) target[m] -= factor * source[m];
    }
  }
}

void BandMatrix::solve_in_place(Eigen::VectorXd& x) const {
  for (int j = 0; j < n_; ++j) {
    if (held_[static_cast<std::size_t>(j)] != 0) x[j] = 0.0;
    const double* column = column_begin(j);
    const int below = std::min(band_, n_ - 1 - j);
    const double value = x[j] / column[0];
    x[j] = value;
    for (int k = 1; k <= below; ++k) x[j + k] -= column[k] * value;
  }
  for (int j = n_ - 1; j >= 0; --j) {
    const double* column = column_begin(j);
    const int below = std::min(band_, n_ - 1 - j);
    double sum = x[j];
    for (int k = 1; k <= below; ++k) sum -= column[k] * x[j + k];
    x[j] = held_[static_cast<std::size_t>(j)] != 0 ? 0.0 : sum / column[0];
  }
}

}  // namespace trussmap::linalg
