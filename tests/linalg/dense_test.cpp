// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/dense.hpp"

#include <gtest/gtest.h>

namespace trussmap::dense_test {
using namespace linalg;
namespace {

/// Three springs in a row between four joints, the first held by a fourth of this stiffness.
Eigen::MatrixXd chain(double held) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index k = 0; k < 3; ++k) {
    K.block<2, 2>(k, k) += (Eigen::Matrix2d() << 1.0, -1.0, -1.0, 1.0).finished();
  }
  K(0, 0) += held;
  return K;
}

TEST(DenseCholesky, SolvesByTheFactorAndByItsHalf) {
  const Eigen::MatrixXd K = chain(0.5);
  const DenseCholesky factor(K);
  ASSERT_TRUE(factor.positive_definite());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(4, -1.0, 2.0);
  EXPECT_LT((K * factor.solve(b) - b).cwiseAbs().maxCoeff(), 1e-14);
  // |L^-T b|^2 in the measure of K is |b|^2.
  const Eigen::VectorXd half = factor.solve_half(b);
  EXPECT_NEAR(half.dot(K * half), b.squaredNorm(), 1e-13);
}

/// Of the chain's last joint, whose own stiffness is 1, what is left where all others are free is
/// the compliance in series: 1/(3 + 1/held). Of a diagonal matrix it is all.
TEST(DenseCholesky, LeastPivotShareIsWhatOthersLeave) {
  for (const double held : {1.0, 1e-3, 1e-6}) {
    EXPECT_NEAR(DenseCholesky(chain(held)).least_pivot_share(), 1.0 / (3.0 + 1.0 / held),
                1e-9 * held);
  }
  const Eigen::MatrixXd diagonal = Eigen::Vector3d(1e-9, 1.0, 1e9).asDiagonal();
  EXPECT_DOUBLE_EQ(DenseCholesky(diagonal).least_pivot_share(), 1.0);
  EXPECT_EQ(DenseCholesky(Eigen::MatrixXd(0, 0)).least_pivot_share(), 1.0);
}

}  // namespace
}  // namespace trussmap::dense_test
