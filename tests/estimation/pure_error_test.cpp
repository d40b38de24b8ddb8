// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pure error and lack of fit: their sum by algebra, their distribution by simulation.
#include "estimation/pure_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::pure_error_test {
using namespace estimation;
namespace {

/// A ring of eight with chords, true positions.
LandmarkGraph ring() {
  LandmarkGraph map;
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.25 * M_PI * k;
    map.add_landmark("n" + std::to_string(k), {6.0 * std::cos(angle), 4.0 * std::sin(angle)});
  }
  return map;
}

struct World {
  double noise_scale = 1.0;  ///< true sd over believed sd
  double bend = 0.0;         ///< m, sd of an error that repeats with its route
};

/// Each of 16 routes driven 1 to 4 times, both ways, with covariances of their own.
std::vector<Repeat> drive(const LandmarkGraph& map, const World& world, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Repeat> repeats;
  for (int k = 0; k < 8; ++k) {
    for (const int step : {1, 3}) {
      const int to = (k + step) % 8;
      const Vector2 bend = world.bend * Vector2(normal(random), normal(random));
      for (int t = 0; t <= k % 4; ++t) {
        const Matrix2 root = (Matrix2() << 0.2, 0.0, 0.1 * normal(random), 0.1).finished();
        const Vector2 noise = world.noise_scale * root * Vector2(normal(random), normal(random));
        const Vector2 way = map.landmark(to).position - map.landmark(k).position + bend + noise;
        if (t % 2 == 0) {
          repeats.push_back({k, to, {way, root * root.transpose()}});
        } else {
          repeats.push_back({to, k, {-way, root * root.transpose()}});
        }
      }
    }
  }
  return repeats;
}

TEST(PureError, AndLackOfFitSumToTheWhole) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const LandmarkGraph truth = ring();
    const std::vector<Repeat> repeats = drive(truth, {1.0, 0.3}, seed);
    const PureErrorSplit split = split_pure_error(truth, repeats);
    double total = 0.0;
    for (const Repeat& one : repeats) {
      const Vector2 off = split.map.landmark(one.to).position -
                          split.map.landmark(one.from).position - one.traversal.displacement;
      total += off.dot(one.traversal.covariance.inverse() * off);
    }
    EXPECT_NEAR(split.pure_error + split.lack_of_fit, total, 1e-9 * total) << seed;
    EXPECT_EQ(split.pure_error_dof + split.lack_of_fit_dof,
              2 * static_cast<int>(repeats.size()) - 2 * (truth.landmarks() - 1));
  }
}

TEST(PureError, RepeatsBecomeOneElementWithCountMeanAndScatter) {
  const Matrix2 C = Vector2(0.04, 0.01).asDiagonal();
  const std::vector<Repeat> repeats = {
      {0, 1, {{2.0, 0.1}, C}}, {1, 0, {{-2.2, 0.1}, C}}, {1, 2, {{0.0, 3.0}, C}}};
  const std::vector<MergedRoute> merged = merge_repeats(repeats);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].count, 2);
  EXPECT_LT((merged[0].mean - Vector2(2.1, 0.0)).norm(), 1e-12);
  EXPECT_LT((merged[0].stiffness - 2.0 * C.inverse()).norm(), 1e-9);
  EXPECT_NEAR(merged[0].scatter, 2.0 * (0.01 / 0.04 + 0.01 / 0.01), 1e-12);
  EXPECT_EQ(merged[1].count, 1);
  EXPECT_EQ(merged[1].scatter, 0.0);
}

/// 1000 worlds, seeds 1 to 1000: shares of p below 0.05 and 0.5 within 4 standard errors of a
/// binomial, 4 sqrt(p (1 - p)/1000), whatever the noise's scale; pure error/dof is its square.
TEST(PureError, FIsFishersWhateverTheScaleOfTheNoise) {
  const LandmarkGraph truth = ring();
  for (const double scale : {1.0, 3.0}) {
    int below_5 = 0;
    int below_50 = 0;
    double pure = 0.0;
    double dof = 0.0;
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
      const PureErrorSplit split = split_pure_error(truth, drive(truth, {scale, 0.0}, seed));
      below_5 += split.p_value < 0.05 ? 1 : 0;
      below_50 += split.p_value < 0.5 ? 1 : 0;
      pure += split.pure_error / (scale * scale);
      dof += split.pure_error_dof;
    }
    EXPECT_NEAR(below_5 / 1000.0, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / 1000.0)) << scale;
    EXPECT_NEAR(below_50 / 1000.0, 0.5, 4.0 * std::sqrt(0.25 / 1000.0)) << scale;
    EXPECT_NEAR(pure / dof, 1.0, 4.0 * std::sqrt(2.0 / dof)) << scale;  // variance of chi^2: 2 dof
  }
}

/// An error that repeats with its route leaves the pure error alone and is found.
TEST(PureError, WhatRepeatsWithItsRouteIsLackOfFit) {
  const LandmarkGraph truth = ring();
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const PureErrorSplit bent = split_pure_error(truth, drive(truth, {1.0, 0.4}, seed));
    const PureErrorSplit straight = split_pure_error(truth, drive(truth, {1.0, 0.0}, seed));
    EXPECT_NEAR(bent.pure_error, straight.pure_error, 1e-9 * straight.pure_error) << seed;
    found += bent.p_value < 0.01 ? 1 : 0;
  }
  EXPECT_GE(found, 95);
}

TEST(PureError, WithoutRepeatsNothingIsTested) {
  const LandmarkGraph truth = ring();
  std::vector<Repeat> once;
  for (const Repeat& one : drive(truth, {}, 7)) {
    const bool known = std::any_of(once.begin(), once.end(), [&](const Repeat& other) {
      return std::minmax(one.from, one.to) == std::minmax(other.from, other.to);
    });
    if (!known) once.push_back(one);
  }
  const PureErrorSplit split = split_pure_error(truth, once);
  EXPECT_EQ(split.pure_error_dof, 0);
  EXPECT_EQ(split.p_value, 1.0);
  EXPECT_GT(split.lack_of_fit, 0.0);
  once.front().traversal.covariance = Matrix2::Zero();
  EXPECT_THROW((void)merge_repeats(once), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::pure_error_test
