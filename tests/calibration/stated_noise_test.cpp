// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// k as somebody states it, beside runs whose k is known.
#include "trussmap/wheel_noise.hpp"

#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::stated_noise_test {
namespace {

constexpr double kLeft = 0.0004;  // Chong & Kleeman (1997), section 5.2
constexpr double kRight = 0.00058;

NoiseExperiment out_and_back() {
  NoiseExperiment experiment;
  experiment.wheelbase = 0.5;
  return experiment;
}

EndErrors drawn(int runs, std::mt19937_64& random) {
  const NoiseShape shape = noise_shape(out_and_back().path, 0.5);
  const Matrix3 root = (kLeft * kLeft * shape.left + kRight * kRight * shape.right).llt().matrixL();
  std::normal_distribution<double> normal;
  EndErrors errors;
  for (int run = 0; run < runs; ++run) {
    const double a = normal(random);
    const double b = normal(random);
    errors.push_back(root * Eigen::Vector3d(a, b, normal(random)));
  }
  return errors;
}

StatedNoise judged(const EndErrors& errors, double left, double right) {
  const NoiseEstimate estimate = estimate_wheel_noise(errors, out_and_back());
  return stated_noise(errors, out_and_back(), estimate, left, right);
}

TEST(StatedNoise, CountsRunsWithinItsEllipses) {
  std::mt19937_64 random(1);
  const EndErrors errors = drawn(60, random);
  const StatedNoise found = judged(errors, 0.0005, 0.0005);
  ASSERT_EQ(found.counts.size(), 4U);
  const std::vector<std::vector<int>> planes = {{0, 1}, {0, 2}, {1, 2}};
  for (std::size_t plane = 0; plane < 3; ++plane) {
    // Inside where the run, scaled by 1/s, lies in the ellipse: by the 2 x 2 inverse written out.
    const double a = found.modelled(planes[plane][0], planes[plane][0]);
    const double b = found.modelled(planes[plane][0], planes[plane][1]);
    const double c = found.modelled(planes[plane][1], planes[plane][1]);
    std::array<int, 3> inside = {};
    for (const Eigen::Vector3d& e : errors) {
      const double u = e[planes[plane][0]];
      const double v = e[planes[plane][1]];
      const double squared = (c * u * u - 2.0 * b * u * v + a * v * v) / (a * c - b * b);
      for (int s = 1; s <= 3; ++s) inside[static_cast<std::size_t>(s - 1)] += squared <= s * s;
    }
    EXPECT_EQ(found.counts[plane].inside, inside) << plane;
    for (int s = 1; s <= 3; ++s) {
      EXPECT_NEAR(found.counts[plane].expected[static_cast<std::size_t>(s - 1)],
                  60.0 * (1.0 - std::exp(-0.5 * s * s)), 1e-9);
    }
  }
  // In space: 19.87, 73.85 and 97.07 %.
  EXPECT_NEAR(found.counts[3].expected[0], 60.0 * 0.198748, 1e-4);
  EXPECT_NEAR(found.counts[3].expected[1], 60.0 * 0.738536, 1e-4);
  EXPECT_NEAR(found.counts[3].expected[2], 60.0 * 0.970709, 1e-4);
}

TEST(StatedNoise, TheTrueOneIsContradictedAsOftenAsStated) {
  std::mt19937_64 random(2);
  constexpr int kTrials = 1000;
  int rejected = 0;
  int within_one = 0;
  int far_off = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const EndErrors errors = drawn(60, random);
    const StatedNoise found = judged(errors, kLeft, kRight);
    rejected += found.p_value < 0.05 ? 1 : 0;
    within_one += found.counts[0].inside[0];
    far_off += judged(errors, 2.0 * kLeft, kRight).p_value < 0.05 ? 1 : 0;
  }
  // 5 %, three standard errors of 1000 trials; 60 000 runs, 39.35 % of them within one.
  EXPECT_NEAR(rejected / double{kTrials}, 0.05, 0.021);
  EXPECT_NEAR(within_one / (60.0 * kTrials), 0.3935, 0.006);
  EXPECT_GT(far_off, 990);
}

TEST(StatedNoise, TheEstimateItselfIsNotContradicted) {
  std::mt19937_64 random(3);
  const EndErrors errors = drawn(60, random);
  for (const bool subtract : {false, true}) {
    NoiseExperiment experiment = out_and_back();
    experiment.subtract_mean = subtract;
    experiment.sensor_sd = {0.0005, 0.001, 0.0005};
    for (const NoiseOrder order : {NoiseOrder::first, NoiseOrder::exact}) {
      experiment.order = order;
      const NoiseEstimate estimate = estimate_wheel_noise(errors, experiment);
      const StatedNoise same =
          stated_noise(errors, experiment, estimate, estimate.left.k, estimate.right.k);
      EXPECT_NEAR(same.p_value, 1.0, 1e-6);
      EXPECT_LT((same.modelled - estimate.modelled).norm(), 1e-12 * estimate.modelled.norm());
      EXPECT_LT((same.centre - estimate.centre).norm(), 1e-12);
    }
  }
  EXPECT_THROW((void)judged(errors, 0.0, kRight), std::invalid_argument);
  EXPECT_THROW((void)judged(errors, kLeft, std::nan("")), std::invalid_argument);
}

TEST(StatedNoise, StandsInTheAnalysisWhereAsked) {
  std::mt19937_64 random(4);
  const EndErrors errors = drawn(60, random);
  EXPECT_FALSE(analyse_wheel_noise(errors, out_and_back()).stated);
  const NoiseAnalysis found = analyse_wheel_noise(errors, out_and_back(), Vector2(kLeft, kRight));
  ASSERT_TRUE(found.stated);
  EXPECT_EQ(found.stated->left, kLeft);
  EXPECT_EQ(found.stated->p_value, judged(errors, kLeft, kRight).p_value);
}

}  // namespace
}  // namespace trussmap::stated_noise_test
