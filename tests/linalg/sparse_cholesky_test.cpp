// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// CHOLMOD behind its door: determinants, updated and grown factors, against dense ones.
#include "linalg/sparse_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::sparse_cholesky_test {
using namespace linalg;
namespace {

/// Lower triangle of a sum of (2 x 1)-blocked springs between random nodes, those of a tree among
/// them, the first of which is held (seed).
SparseMatrix random_springs(int nodes, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const int n = 2 * (nodes - 1);
  std::vector<Eigen::Triplet<double, int>> entries;
  const auto spring = [&](int a, int b) {  // nodes; 0 is the ground
    Eigen::Matrix2d W;
    W << normal(random), normal(random), normal(random), normal(random);
    const Eigen::Matrix2d B = W * W.transpose() + Eigen::Matrix2d::Identity();
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        for (const int node : {a, b}) {
          if (node > 0 && r >= c) entries.emplace_back(2 * node - 2 + r, 2 * node - 2 + c, B(r, c));
        }
        if (std::min(a, b) == 0) continue;
        entries.emplace_back(2 * std::max(a, b) - 2 + r, 2 * std::min(a, b) - 2 + c, -B(r, c));
      }
    }
  };
  for (int k = 1; k < nodes; ++k) spring(k, std::uniform_int_distribution<int>(0, k - 1)(random));
  for (int k = 1; k < nodes; ++k) spring(k - 1, k);
  SparseMatrix lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

/// Small (simplicial) and large (supernodal) factors, and one that was updated (LDL').
TEST(SparseCholesky, KnowsTheDeterminant) {
  for (const int joints : {5, 40, 400}) {
    const SparseMatrix K = random_springs(joints, 12);
    SparseCholesky cholesky;
    cholesky.analyse(K);
    cholesky.factorise(K);
    const Eigen::MatrixXd dense = Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>();
    const double expected = 2.0 * dense.llt().matrixLLT().diagonal().array().log().sum();
    EXPECT_NEAR(cholesky.log_determinant(), expected, 1e-10 * std::abs(expected));
    SparseMatrix w(2 * (joints - 1), 1);
    w.insert(3, 0) = 2.0;
    w.makeCompressed();
    cholesky.update(w);
    const double updated =
        2.0 * Eigen::MatrixXd(dense + Eigen::MatrixXd(w) * Eigen::MatrixXd(w).transpose())
                  .llt()
                  .matrixLLT()
                  .diagonal()
                  .array()
                  .log()
                  .sum();
    EXPECT_NEAR(cholesky.log_determinant(), updated, 1e-10 * std::abs(updated));
  }
}

TEST(SparseCholesky, AnUpdatedFactorEqualsANewOne) {
  const SparseMatrix K = random_springs(40, 11);
  SparseCholesky live;
  live.analyse(K);
  live.factorise(K);
  const Eigen::Matrix2d W = (Eigen::Matrix2d() << 2.0, 0.0, 0.5, 1.0).finished();
  SparseMatrix update(78, 2);
  for (int c = 0; c < 2; ++c) {
    for (int r = 0; r < 2; ++r) {
      update.insert(2 * 4 + r, c) = -W(r, c);
      update.insert(2 * 30 + r, c) = W(r, c);
    }
  }
  update.makeCompressed();
  live.update(update);
  const Eigen::MatrixXd w(update);
  const Eigen::MatrixXd dense = Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(78, -1.0, 2.0);
  const Eigen::VectorXd expected = (dense + w * w.transpose()).llt().solve(b);
  EXPECT_LE((live.solve(b) - expected).norm(), 1e-10 * expected.norm());
}

TEST(SparseCholesky, AFactorThatGrewByRowsEqualsANewOne) {
  // The last joints wait as identity and come in one by one, each with all its bars to those there.
  const SparseMatrix K = random_springs(40, 12);
  const Eigen::MatrixXd whole = Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>();
  constexpr int kThere = 60;  // unknowns that are there from the start
  Eigen::MatrixXd part = Eigen::MatrixXd::Identity(78, 78);
  part.topLeftCorner(kThere, kThere) = whole.topLeftCorner(kThere, kThere);
  const Eigen::MatrixXd lower = part.triangularView<Eigen::Lower>();
  SparseCholesky live(Ordering::fixed);
  live.analyse(SparseMatrix(lower.sparseView()));
  live.factorise(SparseMatrix(lower.sparseView()));
  for (int row = kThere; row < 78; ++row) {
    Eigen::MatrixXd column = Eigen::MatrixXd::Zero(78, 1);
    column.topRows(row + 1) = whole.block(0, row, row + 1, 1);
    live.add_row(row, SparseMatrix(column.sparseView()));
  }
  SparseCholesky fresh;
  fresh.analyse(K);
  fresh.factorise(K);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(78, -1.0, 2.0);
  const Eigen::VectorXd expected = fresh.solve(b);
  EXPECT_LE((live.solve(b) - expected).norm(), 1e-10 * expected.norm());
  Eigen::VectorXd x = b;
  live.solve_updated(x);
  EXPECT_LE((x - expected).norm(), 1e-10 * expected.norm());
}

}  // namespace
}  // namespace trussmap::sparse_cholesky_test
