// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/selected_inverse.hpp"

#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::selected_inverse_test {
using namespace linalg;
namespace {

/// A chain with some chords, as a robot's poses are.
Eigen::MatrixXd chain_with_chords(int size, std::mt19937_64& random) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  const auto join = [&](int i, int j) {
    const double k = 0.5 + static_cast<double>(random() % 100) / 100.0;
    A(i, i) += k;
    A(j, j) += k;
    A(i, j) -= k;
    A(j, i) -= k;
  };
  for (int k = 0; k + 1 < size; ++k) join(k, k + 1);
  for (int k = 0; k < size / 4; ++k) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(size));
    const int j = static_cast<int>(random() % static_cast<unsigned>(size));
    if (i != j) join(i, j);
  }
  A(0, 0) += 1.0;
  return A;
}

TEST(SelectedInverse, EqualsTheInverseWhereTheMatrixHasEntries) {
  std::mt19937_64 random(1);
  for (const int size : {1, 2, 7, 40}) {
    const Eigen::MatrixXd A = chain_with_chords(size, random);
    const Eigen::MatrixXd lower = A.triangularView<Eigen::Lower>();
    const SelectedInverse selected(SparseMatrix(lower.sparseView()));
    const Eigen::MatrixXd inverse = A.inverse();
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) {
        if (A(i, j) == 0.0) continue;
        EXPECT_NEAR(selected(i, j), inverse(i, j), 1e-11 * inverse.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST(SelectedInverse, RefusesAMatrixThatIsNotPositiveDefinite) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
  A(1, 1) = -1.0;
  EXPECT_THROW(SelectedInverse(SparseMatrix(A.sparseView())), NotPositiveDefinite);
}

}  // namespace
}  // namespace trussmap::selected_inverse_test
