// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sets of candidates against a search without bounds, and their evidence against integrals.
#include "criticism/subset_search.hpp"

#include "trussmap/running.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::subset_search_test {
using namespace criticism;
namespace {

/// Columns of each candidate and residuals of which some of them explain much.
struct Problem {
  CandidateGram gram;
  SetBelief belief;
  Eigen::MatrixXd X;
  Eigen::VectorXd r;
};

Problem problem_of(const std::vector<Eigen::MatrixXd>& columns, const Eigen::VectorXd& r) {
  Problem result;
  Eigen::Index count = 0;
  for (const Eigen::MatrixXd& one : columns) count += one.cols();
  result.X.resize(r.size(), count);
  result.r = r;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Eigen::Index size = columns[k].cols();
    const Eigen::HouseholderQR<Eigen::MatrixXd> factor(columns[k]);
    result.X.middleCols(first, size) =
        factor.householderQ() * Eigen::MatrixXd::Identity(r.size(), size);
    result.gram.blocks.push_back(
        {k, first, size, Eigen::MatrixXd::Identity(size, size), Eigen::VectorXd::Zero(size)});
    result.belief.blocks.push_back({k, -0.1 * static_cast<double>(k % 7), 1.0, 0, 0.0});
    first += size;
  }
  result.gram.G = result.X.transpose() * result.X;
  result.gram.g = result.X.transpose() * r;
  std::vector<double> log_beliefs;
  for (const BlockBelief& one : result.belief.blocks) log_beliefs.push_back(one.log_share);
  result.belief.log_sets = log_symmetric(log_beliefs, 4);
  return result;
}

/// 24 candidates of 1 to 3 columns with something in common, in 60 rows; three of them act, two of
/// these against each other.
Problem drawn(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr Eigen::Index kRows = 60;
  const auto draw = [&](Eigen::Index cols) {
    return Eigen::MatrixXd(
        Eigen::MatrixXd::NullaryExpr(kRows, cols, [&] { return normal(random); }));
  };
  const Eigen::MatrixXd common = draw(4);
  std::vector<Eigen::MatrixXd> columns;
  for (int k = 0; k < 24; ++k) {
    const Eigen::Index size = k % 5 == 0 ? 3 : k % 3 == 0 ? 2 : 1;
    const double own = 0.3 + 0.1 * (k % 6);
    Eigen::MatrixXd mixing(4, size);
    for (double& one : mixing.reshaped()) one = normal(random);
    columns.push_back(common * mixing + own * draw(size));
  }
  Eigen::VectorXd r = draw(1);
  r += 8.0 * (columns[1].col(0).normalized() - columns[2].col(0).normalized());
  r += 6.0 * columns[7].col(0).normalized();
  return problem_of(columns, r);
}

/// All sets of up to three, without any bound.
std::vector<CandidateSet> all_sets(const SubsetSearch& search, int count, double window) {
  std::vector<CandidateSet> all{CandidateSet{}};
  const auto add = [&](CandidateSet set) {
    if (search.weigh(set)) all.push_back(set);
  };
  for (int i = 0; i < count; ++i) {
    add({{i}, 1});
    for (int j = i + 1; j < count; ++j) {
      add({{i, j}, 2});
      for (int k = j + 1; k < count; ++k) add({{i, j, k}, 3});
    }
  }
  double best = 0.0;
  for (const CandidateSet& one : all) best = std::max(best, one.log_evidence);
  std::erase_if(all, [&](const CandidateSet& one) { return one.log_evidence < best - window; });
  std::sort(all.begin(), all.end(), [](const CandidateSet& a, const CandidateSet& b) {
    return a.log_evidence > b.log_evidence;
  });
  return all;
}

TEST(SubsetSearch, BoundsLoseNothingThatCounts) {
  std::size_t listed = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Problem problem = drawn(seed);
    const SubsetSearch search(problem.gram, problem.belief, {1.0, 12.0, 3});
    const std::vector<CandidateSet> found = search.run();
    const std::vector<CandidateSet> all = all_sets(search, 24, 12.0);
    ASSERT_EQ(found.size(), all.size()) << seed;
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(found[k].members, all[k].members) << seed << " " << k;
      EXPECT_DOUBLE_EQ(found[k].log_evidence, all[k].log_evidence);
    }
    listed += all.size();
    EXPECT_LT(all.size(), 2000U) << seed;  // of 2324: or the window would test nothing
  }
  EXPECT_GT(listed, 60U);
}

TEST(SubsetSearch, AGainIsWhatLeastSquaresTakeAway) {
  const Problem problem = drawn(3);
  const SubsetSearch search(problem.gram, problem.belief, {1.0, 12.0, 3});
  for (const std::vector<int>& members : {std::vector{1}, {0, 4}, {1, 2, 7}, {3, 5, 10}}) {
    CandidateSet set;
    Eigen::MatrixXd M(problem.X.rows(), 0);
    for (const int one : members) {
      set.members[idx(set.size++)] = one;
      const ColumnBlock& block = problem.gram.blocks[idx(one)];
      const Eigen::Index had = M.cols();
      M.conservativeResize(Eigen::NoChange, had + block.size);
      M.rightCols(block.size) = problem.X.middleCols(block.first, block.size);
    }
    ASSERT_TRUE(search.weigh(set));
    const Eigen::VectorXd u = M.colPivHouseholderQr().solve(problem.r);
    EXPECT_NEAR(set.gain, problem.r.squaredNorm() - (problem.r - M * u).squaredNorm(), 1e-9);
    EXPECT_TRUE(search.sizes(set).u.isApprox(u, 1e-9));
  }
}

/// Integral over the sizes of two columns of likelihood times prior, by the trapezoidal rule.
double integrated(double cosine, double u1, double u2) {
  // r = x1 v1 + x2 v2 to have g = G v; what is orthogonal to both cancels.
  const double g1 = u1 + cosine * u2;
  const double g2 = cosine * u1 + u2;
  const auto prior = [](double u) {
    return 1.0 / (2.0 * std::log(100.0)) / std::sqrt(1.0 + u * u);
  };
  const double reach = 9.0 / std::sqrt(1.0 - cosine * cosine);
  constexpr int kSteps = 800;
  const double step = 2.0 * reach / kSteps;
  double sum = 0.0;
  for (int a = 0; a <= kSteps; ++a) {
    for (int b = 0; b <= kSteps; ++b) {
      const double x = u1 - reach + a * step;
      const double y = u2 - reach + b * step;
      const double log_likelihood = g1 * x + g2 * y - 0.5 * (x * x + y * y + 2.0 * cosine * x * y);
      sum += std::exp(log_likelihood - 0.5 * (g1 * u1 + g2 * u2)) * prior(x) * prior(y);
    }
  }
  return 0.5 * (g1 * u1 + g2 * u2) + std::log(sum * step * step);
}

TEST(SubsetSearch, TheEvidenceIsTheIntegralOverSizes) {
  for (const double cosine : {0.0, 0.5, -0.8, 0.9}) {
    for (const auto& [u1, u2] : {std::pair{8.0, 12.0}, {15.0, -9.0}, {30.0, 25.0}}) {
      Problem problem;
      problem.gram.G = Eigen::Matrix2d{{1.0, cosine}, {cosine, 1.0}};
      problem.gram.g = problem.gram.G * Eigen::Vector2d(u1, u2);
      for (std::size_t k = 0; k < 2; ++k) {
        problem.gram.blocks.push_back({k, static_cast<Eigen::Index>(k), 1,
                                       Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Zero(1)});
        problem.belief.blocks.push_back({k, 0.0, 1.0, 0, 0.0});
      }
      problem.belief.log_sets = {0.0, std::log(2.0), 0.0};
      const SubsetSearch search(problem.gram, problem.belief, {1.0, 12.0, 2});
      CandidateSet both{{0, 1}, 2};
      ASSERT_TRUE(search.weigh(both));
      // Laplace's approximation is out by terms of the order of var(u)/u^2 each.
      const double out = 2.0 / (1.0 - cosine * cosine) * (1.0 / (u1 * u1) + 1.0 / (u2 * u2));
      EXPECT_NEAR(both.log_evidence, integrated(cosine, u1, u2), out) << cosine << " " << u1;
    }
  }
}

TEST(SubsetSearch, ANameMoreMakesNothingLikelier) {
  // Classes of 1 and of 12 members of the same columns: both classes explain as much.
  std::vector<double> log_beliefs{0.0, 0.0};
  SetBelief belief;
  belief.log_sets = log_symmetric(log_beliefs, 1);
  CandidateGram gram;
  gram.G = Eigen::MatrixXd::Identity(13, 13);
  gram.G.bottomRightCorner(12, 12).setOnes();
  gram.g = Eigen::VectorXd::Constant(13, 6.0);
  for (std::size_t k = 0; k < 13; ++k) {
    gram.blocks.push_back({k, static_cast<Eigen::Index>(k), 1, Eigen::MatrixXd::Identity(1, 1),
                           Eigen::VectorXd::Zero(1)});
    belief.blocks.push_back({k == 0 ? 0U : 1U, k == 0 ? 0.0 : -std::log(12.0), 1.0, 0, 0.0});
  }
  const std::vector<CandidateSet> sets = SubsetSearch(gram, belief, {1.0, 12.0, 1}).run();
  std::map<std::size_t, double> sums;
  for (const CandidateSet& one : sets) {
    if (one.size == 1) {
      sums[belief.blocks[idx(one.members[0])].look_alikes] += std::exp(one.log_evidence);
    }
  }
  EXPECT_NEAR(sums[0], sums[1], 1e-9 * sums[0]);
}

TEST(SubsetSearch, SymmetricPolynomialsCountSets) {
  const std::vector<double> logs(5, std::log(2.0));
  const std::vector<double> e = log_symmetric(logs, 3);
  EXPECT_NEAR(std::exp(e[1]), 10.0, 1e-12);  // 5 of 2
  EXPECT_NEAR(std::exp(e[2]), 40.0, 1e-12);  // 10 pairs of 4
  EXPECT_NEAR(std::exp(e[3]), 80.0, 1e-12);  // 10 triples of 8
}

TEST(SubsetSearch, ThreadsChangeNothing) {
  const Problem problem = drawn(4);
  const SubsetSearch search(problem.gram, problem.belief, {1.0, 12.0, 4});
  set_threads(1);
  const std::vector<CandidateSet> one = search.run();
  set_threads(4);
  const std::vector<CandidateSet> four = search.run();
  set_threads(1);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].members, four[k].members);
    EXPECT_EQ(one[k].log_evidence, four[k].log_evidence);
  }
}

}  // namespace
}  // namespace trussmap::subset_search_test
