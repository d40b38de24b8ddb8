// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/robust_weights.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::robust_weights_test {
using namespace estimation;
namespace {

/// The weight that makes w r^2 + penalty(w) least, on a grid: what weights stand for (Black &
/// Rangarajan 1996; Yang et al., eq. 8).
template <typename Penalty>
double best_weight(double squared_error, Penalty penalty) {
  constexpr int kSteps = 200000;
  double best = 0.0;
  double least = penalty(0.0);
  for (int k = 1; k <= kSteps; ++k) {
    const double w = static_cast<double>(k) / kSteps;
    const double cost = w * squared_error + penalty(w);
    if (cost >= least) continue;
    least = cost;
    best = w;
  }
  return best;
}

TEST(RobustWeights, BentWeightIsTheBestForItsPenalty) {
  constexpr double kGate = 9.0;
  for (const double mu : {0.05, 0.7, 1.0, 30.0}) {
    const auto penalty = [mu](double w) { return kGate * mu * (1.0 - w) / (mu + w); };
    for (const double squared_error : {0.1, 4.0, 8.9, 9.1, 12.0, 400.0}) {
      EXPECT_NEAR(gnc_weight(squared_error, kGate, mu), best_weight(squared_error, penalty), 1e-5)
          << "r^2 = " << squared_error << ", mu = " << mu;
    }
  }
}

TEST(RobustWeights, SoftWeightIsTheBestForItsPenalty) {
  constexpr double kGate = 4.0;
  const auto penalty = [](double w) { return kGate * std::pow(std::sqrt(w) - 1.0, 2); };
  for (const double squared_error : {0.0, 0.3, 4.0, 50.0}) {
    EXPECT_NEAR(soft_weight(squared_error, kGate), best_weight(squared_error, penalty), 1e-5);
  }
}

TEST(RobustWeights, NothingIsOutAtTheFirstBend) {
  constexpr double kGate = 16.0;
  for (const double largest : {17.0, 100.0, 1e6}) {
    const double mu = first_bend(largest, kGate);
    EXPECT_GT(gnc_weight(largest, kGate, mu), 0.0);
    EXPECT_LT(gnc_weight(largest, kGate, mu), 1.0);
  }
}

TEST(RobustWeights, BendingEndsWhereItIsTold) {
  std::vector<double> bends;
  int descents = 0;
  const auto weigh = [&](double mu) {
    bends.push_back(mu);
    return bends.size() < 4;
  };
  const auto descend = [&] { ++descents; };
  bend({.first = 0.1}, weigh, descend);
  EXPECT_EQ(bends.size(), 4U);
  EXPECT_EQ(descents, 4);
  for (std::size_t k = 1; k < bends.size(); ++k) EXPECT_GT(bends[k], bends[k - 1]);

  bends.clear();
  bend({.first = 0.1, .last = 0.15}, weigh, descend);
  EXPECT_EQ(bends.size(), 2U);
  bends.clear();
  bend({.first = 0.1, .most_rounds = 1}, weigh, descend);
  EXPECT_EQ(bends.size(), 1U);
}

TEST(RobustWeights, BendingDescendsTwiceAtLeast) {
  int descents = 0;
  bend(
      {.first = 1.0}, [](double) { return false; }, [&] { ++descents; });
  EXPECT_EQ(descents, 2);
}

TEST(RobustWeights, ReconsideringEnds) {
  int rounds = 0;
  reconsider([&](int round) {
    EXPECT_EQ(round, rounds++);
    return round < 2;
  });
  EXPECT_EQ(rounds, 3);
  rounds = 0;
  reconsider([&](int) { return ++rounds > 0; });
  EXPECT_EQ(rounds, 5);
}

}  // namespace
}  // namespace trussmap::robust_weights_test
