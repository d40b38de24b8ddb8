// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The block system against the same matrix, dense.
#include "linalg/block_system.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace trussmap::block_system_test {
using namespace linalg;
namespace {

/// Nodes of 3, 2, held, 3, 2 unknowns; node 2 is held, nodes 0 and 3 are paired twice.
const std::vector<int> kSizes{3, 2, 0, 3, 2};
const std::vector<NodePair> kPairs{{0, 1}, {3, 0}, {0, 3}, {2, 3}, {4, 3}, {1, 4}};

struct Both {
  BlockSystem system;
  Eigen::MatrixXd dense;
};

template <int Ni, int Nj>
void add(Both& both, int pair, int i, int j, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // A random row a over both nodes contributes a' a, so that the sum is semidefinite.
  Eigen::Matrix<double, 6, Ni> a;
  Eigen::Matrix<double, 6, Nj> b;
  for (double& x : a.reshaped()) x = normal(random);
  for (double& x : b.reshaped()) x = normal(random);
  both.system.add_diagonal<Ni>(i, a.transpose() * a);
  both.system.add_diagonal<Nj>(j, b.transpose() * b);
  both.system.add_coupling<Ni, Nj>(pair, a.transpose() * b);
  if (both.system.size(i) > 0) {
    const int at = both.system.offset(i);
    both.dense.block<Ni, Ni>(at, at) += a.transpose() * a;
  }
  if (both.system.size(j) > 0) {
    const int at = both.system.offset(j);
    both.dense.block<Nj, Nj>(at, at) += b.transpose() * b;
  }
  if (both.system.size(i) > 0 && both.system.size(j) > 0) {
    both.dense.block<Ni, Nj>(both.system.offset(i), both.system.offset(j)) += a.transpose() * b;
    both.dense.block<Nj, Ni>(both.system.offset(j), both.system.offset(i)) += b.transpose() * a;
  }
}

Both assembled(const std::vector<int>& order) {
  std::mt19937_64 random(7);
  Both both{BlockSystem(kSizes, kPairs, order), {}};
  both.dense.setZero(both.system.unknowns(), both.system.unknowns());
  add<3, 2>(both, 0, 0, 1, random);
  add<3, 3>(both, 1, 3, 0, random);
  add<3, 3>(both, 2, 0, 3, random);
  add<3, 3>(both, 3, 2, 3, random);
  add<2, 3>(both, 4, 4, 3, random);
  add<2, 2>(both, 5, 1, 4, random);
  return both;
}

TEST(BlockSystem, HoldsTheSumOfItsBlocksWhateverTheOrder) {
  std::vector<int> order{0, 1, 2, 3, 4};
  do {
    const Both both = assembled(order);
    ASSERT_EQ(both.system.unknowns(), 10);
    const Eigen::MatrixXd lower(both.system.matrix());
    const Eigen::MatrixXd expected = both.dense.triangularView<Eigen::Lower>();
    ASSERT_LT((lower - expected).cwiseAbs().maxCoeff(), 1e-14);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(BlockSystem, SolvesLikeADenseFactorisation) {
  Both both = assembled(elimination_order(5, kPairs));
  both.system.factorise();
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(10, -1.0, 2.0);
  Eigen::VectorXd x = b;
  both.system.solve_in_place(x);
  const Eigen::VectorXd expected = both.dense.llt().solve(b);
  EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
  EXPECT_LT((both.system.solve(b) - expected).norm(), 1e-10 * expected.norm());
}

TEST(BlockSystem, ClearsToZeroAndKeepsItsPattern) {
  Both both = assembled({4, 3, 2, 1, 0});
  const Eigen::Index nonzeros = both.system.matrix().nonZeros();
  both.system.clear();
  EXPECT_EQ(both.system.matrix().norm(), 0.0);
  EXPECT_EQ(both.system.matrix().nonZeros(), nonzeros);
}

TEST(BlockSystem, SetsItsDiagonal) {
  Both both = assembled({4, 3, 2, 1, 0});
  const Eigen::VectorXd wanted = Eigen::VectorXd::LinSpaced(10, 1.0, 10.0);
  both.system.set_diagonal(wanted);
  EXPECT_EQ(both.system.diagonal(), wanted);
  EXPECT_EQ(Eigen::VectorXd(Eigen::MatrixXd(both.system.matrix()).diagonal()), wanted);
}

TEST(EliminationOrder, IsAPermutationOfAllNodes) {
  std::vector<int> order = elimination_order(5, kPairs);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(EliminationOrder, LeavesTheHubOfAStarToTheEnd) {
  // Eliminating the hub first would fill the whole matrix.
  std::vector<NodePair> star;
  for (int leaf = 1; leaf < 20; ++leaf) star.push_back({0, leaf});
  const std::vector<int> order = elimination_order(20, star);
  const auto place = std::find(order.begin(), order.end(), 0) - order.begin();
  EXPECT_GE(place, 18);
}

}  // namespace
}  // namespace trussmap::block_system_test
