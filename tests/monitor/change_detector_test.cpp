// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the bound on false alarms rests on: clipped numbers, the mixture, starts that are given up.
#include "monitor/change_detector.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::change_detector_test {
using namespace monitor;
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kClip = 2.5;

/// E cosh(l psi(w)) of a symmetric density, by the midpoint rule within the clip; the rest is tail.
double clipped_moment(const std::function<double(double)>& density, double l) {
  constexpr int kSteps = 4000;
  const double step = kClip / kSteps;
  double body = 0.0;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = (k + 0.5) * step;
    const double mass = 2.0 * density(x) * step;
    body += mass;
    sum += mass * std::cosh(l * x);
  }
  return sum + (1.0 - body) * std::cosh(l * kClip);
}

double normal(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * kPi);
}

/// Student's t with this many degrees of freedom, variance 1.
double student(double x, double freedom) {
  const double s = std::sqrt((freedom - 2.0) / freedom);
  const double y = x / s;
  return std::tgamma(0.5 * (freedom + 1.0)) /
         (std::sqrt(freedom * kPi) * std::tgamma(0.5 * freedom)) *
         std::pow(1.0 + y * y / freedom, -0.5 * (freedom + 1.0)) / s;
}

TEST(ClippedNumbers, AreNoMoreSpreadThanNormalOnes) {
  for (double l = 0.1; l < 10.0; l += 0.1) {
    const double bound = std::exp(0.5 * l * l) * (1.0 + 1e-6);
    EXPECT_LE(clipped_moment(normal, l), bound) << l;
    for (const double freedom : {2.5, 3.0, 4.0, 6.0, 10.0}) {
      EXPECT_LE(clipped_moment([&](double x) { return student(x, freedom); }, l), bound)
          << freedom << " degrees of freedom, " << l;
    }
  }
  // Not so of numbers twice as spread: the test can fail.
  EXPECT_GT(clipped_moment([](double x) { return 0.5 * normal(0.5 * x); }, 0.5),
            std::exp(0.5 * 0.25));
}

TEST(ChangeDetector, EvidenceIsTheMixtureOverCoefficients) {
  DetectorOptions options;
  options.rate = 2.0;
  options.margin = 1.2;
  ChangeDetector detector(options, {0.3});
  detector.begin(1, 0.01);
  double A = 0.0;
  double Q = 0.0;
  for (const double w : {0.7, -0.4, 1.9, 4.0}) {
    const double h = 1.0 + 0.5 * w;
    detector.take(Eigen::VectorXd::Constant(1, w), Eigen::MatrixXd::Constant(1, 1, h));
    A += h * std::min(w, kClip);
    Q += h * h;
  }
  double mean = 0.0;  // over b ~ N(0, 0.3^2)
  constexpr double kStep = 1e-3;
  for (double z = -8.0; z < 8.0; z += kStep) {
    const double b = 0.3 * z;
    mean += kStep * normal(z) * std::exp(b * A - 0.5 * b * b * 1.44 * Q);
  }
  EXPECT_NEAR(detector.evidence() / (2.0 * 0.01 * mean), 1.0, 1e-6);
}

/// Two effects that show in different directions, of so many starts at most.
ChangeDetector fed(std::size_t starts, int legs, std::uint64_t seed) {
  DetectorOptions options;
  options.rate = 1.0;
  options.starts = starts;
  ChangeDetector detector(options, {0.2, 0.2});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> draw;
  for (int leg = 1; leg <= legs; ++leg) {
    const double before = detector.evidence();
    detector.make_room();
    EXPECT_NEAR(detector.evidence(), before, 1e-12 * (1.0 + before));
    detector.begin(leg, 0.01);
    const auto columns = static_cast<Eigen::Index>(2 * detector.starts());
    Eigen::MatrixXd h(2, columns);
    for (Eigen::Index k = 0; k < columns; k += 2) h.middleCols<2>(k) = Eigen::Matrix2d::Identity();
    detector.take(Eigen::Vector2d(draw(random), draw(random)), h);
  }
  return detector;
}

// Seed 3: the evidence itself is not changed when a start is given up, and as many stay as may.
TEST(ChangeDetector, KeepsItsEvidenceWhereItGivesUpStarts) {
  const ChangeDetector detector = fed(6, 200, 3);
  EXPECT_EQ(detector.starts(), 6U);
  // The ages that are kept span all that was driven.
  const auto legs = detector.since(0, 1.0);
  EXPECT_LE(legs.first, 60);
  EXPECT_GE(legs.second, 190);
}

// M/(rate x hours) is 1 on average at margin 1: seeds 1 to 4000; numbers in which no single drive
// dominates the mean (s^2 Q = 0.04 x 12 at most), its standard error taken from the drives.
TEST(ChangeDetector, IsAFairGameWhileTheModelHolds) {
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kDrives = 4000;
  for (int seed = 1; seed <= kDrives; ++seed) {
    DetectorOptions options;
    options.rate = 1.0;
    options.margin = 1.0;
    options.clip = 100.0;  // none: then normal numbers make it exact
    options.starts = 4;
    ChangeDetector detector(options, {0.2});
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::normal_distribution<double> draw;
    for (int leg = 1; leg <= 12; ++leg) {
      detector.make_room();
      detector.begin(leg, 0.01);
      detector.take(Eigen::VectorXd::Constant(1, draw(random)),
                    Eigen::MatrixXd::Ones(1, static_cast<Eigen::Index>(detector.starts())));
    }
    const double one = detector.evidence() / 0.12;
    sum += one;
    squares += one * one;
  }
  const double mean = sum / kDrives;
  const double error = std::sqrt((squares / kDrives - mean * mean) / kDrives);
  EXPECT_LT(error, 0.02);
  EXPECT_NEAR(mean, 1.0, 4.0 * error);
}

// An effect of 1.5 standard deviations a leg, from leg 101 of 130 on.
TEST(ChangeDetector, TellsWhichEffectAndSinceWhen) {
  DetectorOptions options;
  options.rate = 0.1;
  ChangeDetector detector(options, {1.0, 1.0});
  std::mt19937_64 random(7);
  std::normal_distribution<double> draw;
  for (int leg = 1; leg <= 130; ++leg) {
    detector.make_room();
    detector.begin(leg, 0.003);
    const auto columns = static_cast<Eigen::Index>(2 * detector.starts());
    Eigen::MatrixXd h(2, columns);
    for (Eigen::Index k = 0; k < columns; k += 2) h.middleCols<2>(k) << 1.0, 0.6, 0.0, 0.8;
    const double b = leg > 100 ? 1.5 : 0.0;
    detector.take(Eigen::Vector2d(0.6 * b + draw(random), 0.8 * b + draw(random)), h);
  }
  EXPECT_GT(detector.evidence(), 1.0);
  EXPECT_GT(detector.shares()[1], 0.95);
  const EffectSince since = detector.likeliest(1);
  EXPECT_NEAR(static_cast<double>(since.leg), 101.0, 6.0);
  EXPECT_NEAR(since.coefficient, 1.5, 4.0 * since.sd);
  EXPECT_NEAR(since.sd, 1.1 / std::sqrt(131.0 - static_cast<double>(since.leg)), 1e-9);
  EXPECT_NEAR(detector.cosine(since.start, 0, 1), 0.6, 1e-9);
}

// An effect of one standard deviation from leg 21 on, twice as large from leg 61 on: what was
// announced after leg 40 began before, though the later start speaks more by then.
TEST(ChangeDetector, WhatWasAnnouncedHasBegunByThen) {
  DetectorOptions options;
  options.rate = 0.1;
  ChangeDetector detector(options, {1.0});
  std::mt19937_64 random(11);
  std::normal_distribution<double> draw;
  for (int leg = 1; leg <= 120; ++leg) {
    detector.make_room();
    detector.begin(leg, 0.003);
    const double b = leg > 60 ? 4.0 : leg > 20 ? 0.5 : 0.0;
    detector.take(Eigen::VectorXd::Constant(1, b + draw(random)),
                  Eigen::MatrixXd::Ones(1, static_cast<Eigen::Index>(detector.starts())));
  }
  EXPECT_GT(detector.likeliest(0).leg, 50);
  detector.alarmed(40);
  EXPECT_LE(detector.likeliest(0).leg, 40);
  EXPECT_LE(detector.since(0, 0.9).second, 40);
  detector.clear();
  EXPECT_EQ(detector.starts(), 0U);
}

}  // namespace
}  // namespace trussmap::change_detector_test
