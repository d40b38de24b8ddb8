// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steered robots whose constants are wrong by factors, and whose wheels are not those that the
// model says: what a calibration finds of simulated ones lies within four of its standard errors.
#include "calibration/wheel_calibration.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::steered_calibration_test {
namespace {

SimulationSettings yard(const std::string& drive, std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.spacing = 6.0;
  settings.tours = 2;
  settings.seed = seed;
  settings.drive = drive;
  settings.no_compass = true;
  return settings;
}

const RobotConstant* constant_named(const RobotConstants& found, const std::string& name) {
  const auto at = std::ranges::find(found.list, name, &RobotConstant::name);
  return at == found.list.end() ? nullptr : &*at;
}

void expect_constant(const RobotConstants& found, const std::string& name, double truth) {
  const RobotConstant* one = constant_named(found, name);
  ASSERT_NE(one, nullptr) << name;
  EXPECT_TRUE(one->determined) << name;
  EXPECT_LT(std::abs(one->after - truth), 4.0 * one->sd) << name << ' ' << one->after;
  EXPECT_GT(one->sd, 0.0) << name;
}

/// A robot that really has these wheels, and a model that knows nothing of their places and states
/// so much of the axles' distance.
struct Unknowing {
  SimulatedRecording made;
  Model model;
};

Unknowing unknowing(const SimulationSettings& settings, double length_stated,
                    const std::vector<Effect>& effects = {}) {
  Unknowing one{simulate(settings, effects), {}};
  one.model = one.made.model;
  Robot& robot = one.model.robot;
  robot.length *= length_stated;
  robot.wheelbase = robot.length;
  robot.wheel_left = robot.steer_left = 0.0;
  robot.mounted = {};
  return one;
}

RobotConstants constants_of(const Unknowing& one) {
  return robot_constants(one.model, calibrate_wheels({one.made.drive.recording}, one.model));
}

TEST(SteeredCalibration, FindsAxlesStatedTwiceOrHalfAsFarApart) {
  for (const double stated : {2.0, 0.5}) {
    SimulationSettings settings = yard("ackermann", 21);
    settings.range_sensor = true;
    const Unknowing one = unknowing(settings, stated);
    const RobotConstants found = constants_of(one);
    expect_constant(found, "length", 0.5);
    expect_constant(found, "wheel", 1.0);
    EXPECT_EQ(constant_named(found, "steered wheel left"), nullptr);
    EXPECT_EQ(constant_named(found, "measured wheel left"), nullptr);
  }
}

TEST(SlowSteeredCalibration, FindsAMeasuredWheelBesideTheMiddleAndTheAxles) {
  SimulationSettings settings = yard("ackermann", 22);
  settings.wheel_left = 0.2;
  const Unknowing one = unknowing(settings, 1.3);
  const WheelCalibration found = calibrate_wheels({one.made.drive.recording}, one.model);
  const RobotConstants constants = robot_constants(one.model, found);
  expect_constant(constants, "measured wheel left", 0.2);
  expect_constant(constants, "length", 0.5);
  // The model for a file has both in its robot, and drives as the fitted one.
  const Robot robot = with_wheelbase_in_robot(found.model).robot;
  EXPECT_NEAR(robot.wheel_left, constant_named(constants, "measured wheel left")->after, 1e-9);
  EXPECT_NEAR(robot.length, constant_named(constants, "length")->after, 1e-9);
}

TEST(SlowSteeredCalibration, FindsASteeredWheelBesideTheMiddle) {
  for (const char* drive : {"ackermann", "tricycle"}) {
    SimulationSettings settings = yard(drive, 23);
    settings.steer_left = 0.2;
    const Unknowing one = unknowing(settings, 1.0);
    const RobotConstants found = constants_of(one);
    expect_constant(found, "steered wheel left", 0.2);
    EXPECT_EQ(constant_named(found, "measured wheel left"), nullptr) << drive;
  }
}

/// Which of them is in the middle no motion tells where the antenna is sought, too: the one that
/// leaves the antenna where it is stated, and the other is said.
TEST(SlowSteeredCalibration, TakesTheWheelThatLeavesTheAntennaInTheMiddle) {
  SimulationSettings settings = yard("ackermann", 24);
  settings.fix_rate = 2.0;
  settings.steer_left = 0.2;
  Unknowing one = unknowing(settings, 1.0);
  one.made.drive.recording.sightings.clear();
  one.made.drive.recording.survey.clear();
  const RobotConstants found = constants_of(one);
  expect_constant(found, "steered wheel left", 0.2);
  expect_constant(found, "antenna left", 0.0);
  EXPECT_EQ(constant_named(found, "measured wheel left"), nullptr);
  ASSERT_FALSE(found.doubts.empty());
  EXPECT_NE(found.doubts.front().find("measured wheel"), std::string::npos) << found.doubts.front();
}

TEST(SlowSteeredCalibration, FindsTravelOfTheSteeredWheel) {
  SimulationSettings settings = yard("ackermann", 25);
  const Unknowing one =
      unknowing(settings, 1.0, {catalogue_effect("travel read at the other axle", {1.0})});
  const RobotConstants found = constants_of(one);
  expect_constant(found, "other axle", 1.0);
}

TEST(SteeredCalibration, FindsOffsetAndGainPastWhichStepsLead) {
  SimulationSettings settings = yard("ackermann", 26);
  settings.wheel_left = 0.2;
  Unknowing one = unknowing(
      settings, 1.0,
      {catalogue_effect("steering offset", {-0.15}), catalogue_effect("steering gain", {-0.15})});
  one.model.robot.wheel_left = 0.2;
  const RobotConstants found = constants_of(one);
  expect_constant(found, "steering offset", -0.15);
  expect_constant(found, "wheel", 1.0);
}

}  // namespace
}  // namespace trussmap::steered_calibration_test
