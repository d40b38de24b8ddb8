// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/segment_motion.hpp"

#include "driven.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::segment_motion_test {
using namespace estimation;
namespace {

constexpr double kWheelbase = 0.34;
const Robot kRobot{kWheelbase};

/// A bow, a turn on the spot and a straight line, in small rows; compass in every third.
MotionRows drive_with_compass(int rows, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  MotionRows drive;
  double heading = 3.0;  // near where angles wrap
  for (int k = 0; k < rows; ++k) {
    const double phase = static_cast<double>(k) / rows;
    const double path = phase > 0.5 && phase < 0.6 ? 0.0 : 3.0 / rows;
    const double turn = phase < 0.5 ? 0.8 / rows : phase < 0.6 ? 9.0 / rows : 0.0;
    drive.t.push_back(0.1 * (k + 1));
    testing::add_travels(drive, path - 0.5 * kWheelbase * turn, path + 0.5 * kWheelbase * turn,
                         kWheelbase);
    heading += turn;
    drive.heading.push_back(k % 3 == 0 ? wrap_angle(heading + 0.02 * uniform(random)) : kAbsent);
  }
  return drive;
}

Vector4 numbers(const SegmentMotion& motion) {
  return {motion.displacement.x, motion.displacement.y, motion.displacement.heading,
          motion.mean_heading};
}

Vector4 numbers_of(const MotionRows& drive) {
  return numbers(segment_motion(segment_rows(drive, 0.0, drive.t.back())));
}

/// Central difference by one of the drive's numbers.
template <typename Column>
Vector4 slope_by(const MotionRows& drive, const Column& column, std::size_t row) {
  constexpr double kStep = 1e-6;
  const auto with = [&](double more) {
    MotionRows other = drive;
    column(other)[row] += more;
    testing::retake(other, kWheelbase);
    return numbers_of(other);
  };
  return (with(kStep) - with(-kStep)) / (2.0 * kStep);
}

TEST(SegmentMotion, CovarianceIsThatOfIndependentWheelsAndReadings) {
  // Every wheel travel and reading varied on its own: C = sum of slope slope' variance. Rows are
  // short, so it hardly matters that the closed form lets the noise arise all along a row.
  Noise noise;
  noise.right = 0.005;
  const MotionRows drive = drive_with_compass(600, 1);
  Matrix4 expected = Matrix4::Zero();
  const auto add = [&expected](const Vector4& slope, double variance) {
    expected += variance * slope * slope.transpose();
  };
  const auto left = [](MotionRows& of) -> std::vector<double>& { return of.pair.left; };
  const auto right = [](MotionRows& of) -> std::vector<double>& { return of.pair.right; };
  const auto heading = [](MotionRows& of) -> std::vector<double>& { return of.heading; };
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    add(slope_by(drive, left, row), noise.left * noise.left * std::abs(drive.pair.left[row]));
    add(slope_by(drive, right, row), noise.right * noise.right * std::abs(drive.pair.right[row]));
    if (!std::isnan(drive.heading[row])) {
      add(slope_by(drive, heading, row), noise.compass * noise.compass);
    }
  }
  const auto rows = segment_rows(drive, 0.0, drive.t.back());
  const Matrix4 found = segment_covariance(drive, rows, kRobot, noise);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      EXPECT_NEAR(found(r, c), expected(r, c), 2e-3 * std::sqrt(expected(r, r) * expected(c, c)))
          << r << ", " << c;
    }
  }
  EXPECT_LT(found(2, 3), -1e-4);  // what the turn has too much, the mean heading has too little
}

TEST(SegmentMotion, WithoutReadingsThereIsNoMeanHeading) {
  MotionRows drive = drive_with_compass(30, 2);
  drive.heading.clear();
  const auto rows = segment_rows(drive, 0.0, drive.t.back());
  EXPECT_EQ(readings_of(rows), 0);
  EXPECT_TRUE(std::isnan(segment_motion(rows).mean_heading));
  EXPECT_EQ(segment_covariance(drive, rows, kRobot, Noise()).row(3).norm(), 0.0);
}

TEST(SegmentMotion, MeanHeadingIsTheStartHeadingWhereverItWraps) {
  EXPECT_NEAR(wrap_angle(numbers_of(drive_with_compass(300, 3))[3] - 3.0), 0.0, 0.01);
}

TEST(SegmentMotion, AMergedSegmentIsTheSumOfItsParts) {
  const MotionRows drive = drive_with_compass(60, 4);
  const auto motion = [&](double from, double to) {
    return segment_motion(segment_rows(drive, from, to)).displacement;
  };
  const Pose whole = motion(0.0, drive.t.back());
  const Pose parts = compose(motion(0.0, 2.34), motion(2.34, drive.t.back()));
  // A row cut in two turns evenly along it, so nothing is lost.
  EXPECT_NEAR(whole.x, parts.x, 1e-12);
  EXPECT_NEAR(whole.y, parts.y, 1e-12);
  EXPECT_NEAR(whole.heading, parts.heading, 1e-12);
}

TEST(SegmentMotion, DerivativesByEffectsAreThoseOfDifferences) {
  const MotionRows drive = drive_with_compass(50, 5);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  std::vector<std::vector<effects::DrivePattern>> patterns(3);
  for (auto& pattern : patterns) {
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      pattern.push_back({uniform(random), uniform(random), uniform(random), uniform(random)});
    }
  }
  const std::vector<const std::vector<effects::DrivePattern>*> effects = {&patterns[0], nullptr,
                                                                          &patterns[2]};
  const auto rows = segment_rows(drive, 0.05, 4.93);
  const Eigen::Vector3d at(0.3, 0.2, -0.4);
  const SegmentWithEffects segment = segment_motion(rows, effects, at);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    const Vector4 expected = (numbers(segment_motion(rows, effects, at + step).motion) -
                              numbers(segment_motion(rows, effects, at - step).motion)) /
                             (2.0 * kStep);
    EXPECT_LT((segment.derivatives.col(k) - expected).norm(), 1e-8) << k;
  }
  EXPECT_EQ(segment.derivatives.col(1).norm(), 0.0);
}

}  // namespace
}  // namespace trussmap::segment_motion_test
