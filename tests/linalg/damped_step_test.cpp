// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/damped_step.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::damped_step_test {
using namespace linalg;
namespace {

/// Two nodes of two unknowns: A is [4 1; 1 3] and `last` on the diagonal, coupled a little.
BlockSystem two_nodes(double last) {
  BlockSystem system({2, 2}, {{0, 1}}, {0, 1});
  system.add_diagonal<2>(0, (Eigen::Matrix2d() << 4.0, 1.0, 1.0, 3.0).finished());
  system.add_diagonal<2>(1, (Eigen::Matrix2d() << 2.0, 0.0, 0.0, last).finished());
  system.add_coupling<2, 2>(0, (Eigen::Matrix2d() << 0.5, 0.0, -0.3, 0.0).finished());
  return system;
}

Eigen::MatrixXd dense(const BlockSystem& system) {
  const Eigen::MatrixXd lower = system.matrix();
  Eigen::MatrixXd whole = lower + lower.transpose();
  whole.diagonal() = lower.diagonal();
  return whole;
}

TEST(DampedStep, SolvesWithTheDampedDiagonalAndLeavesTheMatrix) {
  for (const double damping : {0.0, 1e-3, 2.0}) {
    BlockSystem system = two_nodes(1e-6);
    const Eigen::MatrixXd A = dense(system);
    constexpr double kLeast = 1e-2;
    Eigen::VectorXd d = A.diagonal();
    d = d.cwiseMax(kLeast * d.maxCoeff());
    const Eigen::MatrixXd damped = A + damping * Eigen::MatrixXd(d.asDiagonal());
    const Eigen::VectorXd b = Eigen::Vector4d(1.0, -2.0, 0.5, 3.0);
    factorise_damped(system, damping, kLeast);
    Eigen::VectorXd x = b;
    system.solve_in_place(x);
    EXPECT_LT((damped * x - b).norm(), 1e-9);
    EXPECT_EQ(dense(system), A);
  }
}

TEST(DampedStep, LeavesTheMatrixWhereItCannotBeFactorised) {
  BlockSystem system = two_nodes(-1.0);
  const Eigen::MatrixXd A = dense(system);
  EXPECT_THROW(factorise_damped(system, 1e-3), NotPositiveDefinite);
  EXPECT_EQ(dense(system), A);
}

TEST(DampedStep, PredictsWhatTheQuadraticLoses) {
  BlockSystem system = two_nodes(1.0);
  const Eigen::MatrixXd A = dense(system);
  const Eigen::VectorXd g = Eigen::Vector4d(1.0, -2.0, 0.5, 3.0);
  for (const double damping : {0.0, 0.7}) {
    factorise_damped(system, damping);
    Eigen::VectorXd step = -g;
    system.solve_in_place(step);
    const double lost = -(2.0 * g.dot(step) + step.dot(A * step));
    EXPECT_NEAR(predicted_decrease(step, g, system.diagonal(), damping), lost, 1e-12);
  }
}

}  // namespace
}  // namespace trussmap::damped_step_test
