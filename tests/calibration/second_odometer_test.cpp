// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A second odometer, two unloaded encoder wheels as Chong & Kleeman's robot has them, in place of
// truth: its motion over each second stands in loops.csv.
#include "calibration/wheel_calibration.hpp"
#include "driven.hpp"
#include "estimation/drawn_drive.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::second_odometer_test {
using namespace calibration;
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
  const WheelCalibration found = calibrate_wheels(
      {testing::driven(recorded(figure(), 0.0, 0.0, 1))}, model_of(0.001), options);
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
    const WheelCalibration found =
        calibrate_wheels({testing::driven(recorded(figure(), kWheels, 0.0005,
                                                   100 + static_cast<std::uint64_t>(trial)))},
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

/// The encoders' own drive, on their own clock of rows, in place of loops that were made by hand.
TEST(SecondOdometer, ItsDriveBecomesMotionsThatGiveTheWheels) {
  DrawnRobot encoders;
  encoders.nominal_wheelbase = kEncoderBase;
  Recording second = draw(figure(), encoders);
  second.drive.heading.assign(second.drive.rows(), 0.3);  // it has a compass, which is not asked
  Model own = model_of(0.0005);
  own.robot.wheelbase = kEncoderBase;
  Recording recording = draw(figure(), faulty(0.0));
  recording.truth.clear();
  recording.loops = second_odometer_loops(second, own, recording.drive, 0.95);
  std::mt19937_64 random(1);
  const std::vector<Loop> expected = seen_by_encoders(figure(), 0.0, random);
  ASSERT_EQ(recording.loops.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Loop& one = recording.loops[k];
    EXPECT_NEAR(one.t, expected[k].t, 1e-9);
    EXPECT_NEAR(one.t2, expected[k].t2, 1e-9);
    EXPECT_NEAR(one.dx, expected[k].dx, 1e-12);
    EXPECT_NEAR(one.dy, expected[k].dy, 1e-12);
    EXPECT_NEAR(one.dtheta, expected[k].dtheta, 1e-12);
  }
  // The second second, 0.5 m straight ahead: along and aside as Chong & Kleeman's straight line.
  const double c2 = 0.0005 * 0.0005 * 2.0 * 0.5;
  const double aside = 0.5 * 0.5 * c2 / (3.0 * kEncoderBase * kEncoderBase);
  EXPECT_NEAR(recording.loops[1].sd, std::sqrt(0.5 * (c2 / 4.0 + aside)), 1e-9);
  EXPECT_NEAR(recording.loops[1].sd_heading, std::sqrt(c2) / kEncoderBase, 1e-9);
  WheelCalibrationOptions options;
  options.noise = false;
  const WheelCalibration found =
      calibrate_wheels({testing::driven(recording)}, model_of(0.001), options);
  ASSERT_TRUE(found.diameter_ratio && found.wheelbase_ratio && found.scale);
  EXPECT_NEAR(found.diameter_ratio->value, 1.004, 2e-5);
  EXPECT_NEAR(found.wheelbase_ratio->value, 0.97, 2e-5);
  EXPECT_NEAR(found.scale->value, 1.02, 2e-5);
}

TEST(SecondOdometer, IsRefusedWhereTheDrivesHaveNoTimeInCommon) {
  const Recording recording = draw(figure(), faulty(0.0));
  Recording later = recording;
  for (double& t : later.drive.t) t += 1000.0;
  EXPECT_THROW(static_cast<void>(second_odometer_loops(later, Model(), recording.drive)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(second_odometer_loops(recording, Model(), recording.drive, 0.0)),
               std::invalid_argument);
}

TEST(SecondOdometer, LoopsThatOnlyCloseGiveNoScale) {
  Recording recording = recorded(figure(), 0.0, 0.0, 1);
  for (Loop& loop : recording.loops) loop.sd = std::hypot(loop.dx, loop.dy) / 5.0 + 0.001;
  WheelCalibrationOptions options;
  options.noise = false;
  const WheelCalibration found =
      calibrate_wheels({testing::driven(recording)}, model_of(0.001), options);
  EXPECT_FALSE(found.scale);
  ASSERT_FALSE(found.undetermined.empty());
  EXPECT_NE(found.undetermined.front().find("measures a distance"), std::string::npos);
}

}  // namespace
}  // namespace trussmap::second_odometer_test
