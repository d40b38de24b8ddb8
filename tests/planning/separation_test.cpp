// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/separation.hpp"

#include "statistics/distributions.hpp"

#include <cmath>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::separation_test {
using namespace planning;
using namespace statistics;
namespace {

/// Columns of 40 rows: two of an effect, one of its rival, one of what is fitted beside.
struct Rows {
  Eigen::MatrixXd X = Eigen::MatrixXd(40, 4);
  Question question;

  Rows() {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (double& value : X.reshaped()) value = normal(random);
    X.col(2) += 2.0 * X.col(0);
    question.columns = {0, 1};
    question.others = {2};
    question.sizes = Eigen::Vector2d(0.9, -0.5);
  }
};

double misfit(const Eigen::MatrixXd& X, const std::vector<Eigen::Index>& columns,
              const Eigen::VectorXd& y) {
  const Eigen::MatrixXd of = X(Eigen::all, columns);
  return (y - of * of.colPivHouseholderQr().solve(y)).squaredNorm();
}

/// 4000 draws of the rows' noise: the rival's chi^2 less that with the effect beside it has the
/// mean lambda + 2 and the variance 2 (2 + 2 lambda); the power is the share above the threshold.
TEST(Separation, IsWhatRefitsOfManyDrawsSay) {
  Rows rows;
  const double lambda = separation(rows.X.transpose() * rows.X, rows.question, {3}, 1.0);
  rows.question.threshold = 9.0;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  double sum = 0.0;
  int above = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd y = rows.X.leftCols(2) * rows.question.sizes;
    for (double& value : y) value += normal(random);
    const double gain = misfit(rows.X, {2, 3}, y) - misfit(rows.X, {0, 1, 2, 3}, y);
    sum += gain;
    above += gain > 9.0 ? 1 : 0;
  }
  const double sd = std::sqrt(2.0 * (2.0 + 2.0 * lambda) / kDraws);
  EXPECT_NEAR(sum / kDraws, lambda + 2.0, 4.0 * sd);
  const double power = power_of(rows.question, lambda);
  EXPECT_NEAR(static_cast<double>(above) / kDraws, power,
              4.0 * std::sqrt(power * (1.0 - power) / kDraws));
  EXPECT_GT(lambda, 3.0);
}

TEST(Separation, NoiseTwiceAsLargeIsAQuarterOfIt) {
  Rows rows;
  const Eigen::MatrixXd gram = rows.X.transpose() * rows.X;
  EXPECT_NEAR(separation(gram, rows.question, {3}, 4.0),
              0.25 * separation(gram, rows.question, {3}, 1.0), 1e-12);
}

/// Of one degree of freedom the tail is that of a shifted normal variable, two-sided.
TEST(NoncentralChi2, IsTheSquareOfAShiftedNormalVariable) {
  for (const double shift : {0.0, 0.5, 3.0, 6.0}) {
    for (const double bound : {0.7, 2.6, 5.0}) {
      const double expected = normal_p_value(bound - shift) + normal_p_value(bound + shift);
      EXPECT_NEAR(noncentral_chi2_tail(bound * bound, 1.0, shift * shift), expected, 1e-10);
    }
  }
}

/// (1.96 + 1.645)^2, from tables of the normal distribution; a size that is itself uncertain by a
/// tenth wants more, a known one exactly that.
TEST(WantPower, IsTheTextbooksNoncentrality) {
  Question one;
  one.columns = {0};
  one.threshold = chi2_quantile(0.95, 1.0);
  want_power(one, 0.95);
  EXPECT_NEAR(one.wanted, 12.995, 0.01);
  EXPECT_NEAR(power_of(one, one.wanted), 0.95, 1e-6);
  Question uncertain = one;
  uncertain.sd_share = 0.1;
  want_power(uncertain, 0.95);
  EXPECT_GT(uncertain.wanted, 1.05 * one.wanted);
}

}  // namespace
}  // namespace trussmap::separation_test
