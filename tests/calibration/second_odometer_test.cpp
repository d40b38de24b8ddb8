// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A second odometer, two unloaded encoder wheels as Chong & Kleeman's robot has them, in place of
// truth: its motion over each second stands in loops.csv.
#include "calibration/wheel_calibration.hpp"
#include "estimation/drawn_drive.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::after;
using testing::draw;
using testing::DrawnPose;
using testing::DrawnRobot;
using testing::figure;
using testing::Stretch;

constexpr double kEncoderBase = 0.42;  // m

DrawnRobot faulty(double noise) {
  DrawnRobot robot;
  robot.E_d = 1.004;
  robot.E_b = 0.97;
  robot.E_s = 1.02;
  robot.k_left = robot.k_right = noise;
  return robot;
}

/// What encoder wheels of this k see of the drive, second by second.
std::vector<Loop> seen_by_encoders(const std::vector<Stretch>& drive, double k,
                                   std::mt19937_64& random) {
  constexpr int kSteps = 10;
  constexpr double kStep = 1.0 / kSteps;
  std::normal_distribution<double> normal;
  std::vector<Loop> loops;
  double t = 0.0;
  for (const Stretch& one : drive) {
    for (double from = 0.0; from < one.seconds - 0.5; from += 1.0) {
      DrawnPose pose;
      double travelled = 0.0;
      for (int step = 0; step < kSteps; ++step) {
        double left = kStep * (one.speed - 0.5 * kEncoderBase * one.turn_rate);
        double right = kStep * (one.speed + 0.5 * kEncoderBase * one.turn_rate);
        travelled += std::abs(left) + std::abs(right);
        left += k * std::sqrt(std::abs(left)) * normal(random);
        right += k * std::sqrt(std::abs(right)) * normal(random);
        pose = after(pose, {1.0, 0.5 * (left + right), (right - left) / kEncoderBase}, 1.0);
      }
      // Chong & Kleeman's limits: c2 = k^2 (|L| + |R|); along c2/4, the heading c2/B^2.
      const double c2 = k * k * travelled;
      loops.push_back({t, t + 1.0, pose.x, pose.y, pose.heading,
                       std::max(0.5 * std::sqrt(c2), 1e-5),
                       std::max(std::sqrt(c2) / kEncoderBase, 1e-5)});
      t += 1.0;
    }
  }
  return loops;
}

Recording recorded(const std::vector<Stretch>& drive, double wheels, double encoders,
                   std::uint64_t seed) {
  Recording recording = draw(drive, faulty(wheels), seed);
  recording.truth.clear();
  std::mt19937_64 random(seed + 1000);
  recording.loops = seen_by_encoders(drive, encoders, random);
  return recording;
}

Model model_of(double noise) {
  Model model;
  model.robot.wheelbase = DrawnRobot().nominal_wheelbase;
  model.noise.left = model.noise.right = noise;
  return model;
}

TEST(SecondOdometer, GivesTheWheelsExactlyWhereItIsExact) {
  WheelCalibrationOptions options;
  options.noise = false;
  const WheelCalibration found =
      calibrate_wheels({recorded(figure(), 0.0, 0.0, 1)}, model_of(0.001), options);
  ASSERT_TRUE(found.diameter_ratio && found.wheelbase_ratio && found.scale);
  EXPECT_TRUE(found.undetermined.empty());
  EXPECT_NEAR(found.diameter_ratio->value, 1.004, 2e-5);
  EXPECT_NEAR(found.wheelbase_ratio->value, 0.97, 2e-5);
  EXPECT_NEAR(found.scale->value, 1.02, 2e-5);
}

TEST(SlowSecondOdometer, ItsOwnNoiseLeavesErrorsHonestAndTheWheelsNoiseFound) {
  constexpr double kWheels = 0.003;
  constexpr int kTrials = 12;
  double squares = 0.0;
  Eigen::Vector2d noise = Eigen::Vector2d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const WheelCalibration found = calibrate_wheels(
        {recorded(figure(), kWheels, 0.0005, 100 + static_cast<std::uint64_t>(trial))},
        model_of(0.001), WheelCalibrationOptions());
    ASSERT_TRUE(found.diameter_ratio && found.wheelbase_ratio && found.scale);
    ASSERT_TRUE(found.noise_left && found.noise_right);
    squares += std::pow((found.diameter_ratio->value - 1.004) / found.diameter_ratio->sd, 2) +
               std::pow((found.wheelbase_ratio->value - 0.97) / found.wheelbase_ratio->sd, 2) +
               std::pow((found.scale->value - 1.02) / found.scale->sd, 2);
    noise += Eigen::Vector2d(found.noise_left->value, found.noise_right->value) / kTrials;
  }
  // chi-square(36): 36 +- 8.5, three of them.
  EXPECT_NEAR(squares, 36.0, 26.0);
  // Some 6 % per estimate; of their mean three standard errors, and E_s, which k is counted
  // without.
  EXPECT_NEAR(noise[0], kWheels, 0.08 * kWheels);
  EXPECT_NEAR(noise[1], kWheels, 0.08 * kWheels);
}

TEST(SecondOdometer, LoopsThatOnlyCloseGiveNoScale) {
  Recording recording = recorded(figure(), 0.0, 0.0, 1);
  for (Loop& loop : recording.loops) loop.sd = std::hypot(loop.dx, loop.dy) / 5.0 + 0.001;
  WheelCalibrationOptions options;
  options.noise = false;
  const WheelCalibration found = calibrate_wheels({recording}, model_of(0.001), options);
  EXPECT_FALSE(found.scale);
  ASSERT_FALSE(found.undetermined.empty());
  EXPECT_NE(found.undetermined.front().find("measures a distance"), std::string::npos);
}

}  // namespace
}  // namespace trussmap
