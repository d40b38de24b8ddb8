// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Changed factors against dense ones.
#include "linalg/updatable_factor.hpp"

#include "linalg/sparse_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::updatable_factor_test {
using namespace linalg;
namespace {

class Sequence {
 public:
  Sequence(int n, unsigned seed)
      : n_(n), random_(seed), factor_(n), dense_(Eigen::MatrixXd::Identity(n, n)) {
    for (int k = 0; k < n; ++k) {
      dense_(k, k) = 2.0 + k % 3;
      factor_.append_column(dense_(k, k), nullptr, nullptr, 0);
    }
  }

  /// Columns with the same few rows.
  void change(bool add, int columns, int rows) {
    const std::vector<int> at = some(rows, n_);
    std::vector<std::vector<FactorEntry>> w(static_cast<std::size_t>(columns));
    const double size = add ? 1.0 : 0.05;
    for (auto& column : w) {
      Eigen::VectorXd full = Eigen::VectorXd::Zero(n_);
      for (const int row : at) {
        column.push_back({row, size * normal_(random_)});
        full[row] = column.back().value;
      }
      dense_ += (add ? 1.0 : -1.0) * full * full.transpose();
    }
    factor_.change(add, w);
  }

  /// A row that stands alone comes in, tied to others on both sides of it.
  void add_row(int place) {
    std::vector<FactorEntry> column;
    double sum = 1.0;
    for (const int row : some(4, n_)) {
      if (row == place) continue;
      const double value = 0.3 * normal_(random_);
      column.push_back({row, value});
      dense_(row, place) = dense_(place, row) = value;
      sum += std::abs(value);
    }
    column.push_back({place, 2.0 * sum});
    dense_(place, place) = 2.0 * sum;
    std::sort(column.begin(), column.end(),
              [](const FactorEntry& a, const FactorEntry& b) { return a.row < b.row; });
    factor_.add_row(place, column);
  }

  /// Waits as the identity.
  void clear(int place) {
    dense_.row(place).setZero();
    dense_.col(place).setZero();
    dense_(place, place) = 1.0;
    UpdatableFactor fresh(n_);
    const Eigen::MatrixXd L0 = dense_.llt().matrixL();
    for (int k = 0; k < n_; ++k) {
      std::vector<int> rows;
      std::vector<double> values;
      for (int row = k + 1; row < n_; ++row) {
        if (L0(row, k) == 0.0) continue;
        rows.push_back(row);
        values.push_back(L0(row, k) / L0(k, k));
      }
      fresh.append_column(L0(k, k) * L0(k, k), rows.data(), values.data(),
                          static_cast<int>(rows.size()));
    }
    factor_ = std::move(fresh);
  }

  void expect_right() {
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n_, [this] { return normal_(random_); });
    Eigen::VectorXd x = b;
    factor_.solve_in_place(x);
    const Eigen::VectorXd expected = dense_.llt().solve(b);
    EXPECT_LE((x - expected).norm(), 1e-10 * expected.norm());
    double determinant = 0.0;
    for (const double pivot : factor_.pivots()) determinant += std::log(pivot);
    const Eigen::MatrixXd L = dense_.llt().matrixL();
    EXPECT_NEAR(determinant, 2.0 * L.diagonal().array().log().sum(), 1e-9);
  }

  [[nodiscard]] UpdatableFactor& factor() { return factor_; }

 private:
  std::vector<int> some(int count, int below) {
    std::vector<int> all;
    while (static_cast<int>(all.size()) < count) {
      const int row = std::uniform_int_distribution<int>(0, below - 1)(random_);
      if (std::find(all.begin(), all.end(), row) == all.end()) all.push_back(row);
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  int n_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  UpdatableFactor factor_;
  Eigen::MatrixXd dense_;
};

TEST(UpdatableFactor, FollowsItsMatrixThroughManyChanges) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Sequence one(30, seed);
    for (int round = 0; round < 40; ++round) {
      one.change(true, 1 + round % 4, 1 + (round + static_cast<int>(seed)) % 4);
      one.change(false, 1 + round % 3, 2);
      if (round % 5 == 0) one.expect_right();
    }
    one.expect_right();
  }
}

TEST(UpdatableFactor, TakesRowsInAnywhere) {
  for (unsigned seed = 21; seed <= 40; ++seed) {
    Sequence one(24, seed);
    for (int round = 0; round < 10; ++round) one.change(true, 2, 3);
    for (const int place : {23, 0, 11, 5, 22}) {
      one.clear(place);
      one.expect_right();
      one.add_row(place);
      one.expect_right();
      one.change(true, 2, 4);
      one.change(false, 1, 2);
      one.expect_right();
    }
  }
}

/// Rows come in one after the other, as a map's landmarks do: storage that moves stays bounded.
TEST(UpdatableFactor, KeepsNoMoreThanItNeeds) {
  Sequence one(60, 41);
  for (int round = 0; round < 400; ++round) one.change(true, 2, 2);
  EXPECT_LE(one.factor().nonzeros(), 60.0 * 61.0 / 2.0);
  one.expect_right();
}

TEST(UpdatableFactor, RefusesWhatIsNoLongerPositiveDefinite) {
  Sequence one(6, 42);
  EXPECT_THROW(one.factor().change(false, {{{2, 10.0}}}), NotPositiveDefinite);
  Sequence other(6, 43);
  other.clear(3);
  EXPECT_THROW(other.factor().add_row(3, {{1, 5.0}, {3, 1.0}}), NotPositiveDefinite);
}

}  // namespace
}  // namespace trussmap::updatable_factor_test
