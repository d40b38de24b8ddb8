// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/body_motion.hpp"

#include "driven.hpp"

#include <random>

#include <gtest/gtest.h>

namespace trussmap::body_motion_test {
using namespace drive;
namespace {

const Robot kRobot{.wheelbase = 0.4};

/// Each wheel's travel is the way of its place on the body: ahead at the rate of the middle, and
/// faster or slower by the turn times its distance from there.
TEST(BodyMotion, AWheelTravelsAsItsPlaceOnTheBody) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> size(-0.3, 0.3);
  for (int k = 0; k < 50; ++k) {
    const BodyMotion motion{size(random), 0.0, size(random)};
    const WheelTravel wheels = wheel_travel(motion, kRobot);
    EXPECT_NEAR(wheels.left, motion.forward - 0.2 * motion.turn, 1e-15);
    EXPECT_NEAR(wheels.right, motion.forward + 0.2 * motion.turn, 1e-15);
    const BodyMotion again = body_motion(wheels, kRobot.wheelbase);
    EXPECT_NEAR(again.forward, motion.forward, 1e-15);
    EXPECT_NEAR(again.turn, motion.turn, 1e-14);
  }
}

TEST(BodyMotion, IsAddedToTheSideOnlyWhereADriveGoesThere) {
  MotionRows drive;
  drive.t = {0.1, 0.2};
  drive.forward = {0.1, 0.1};
  drive.turn = {0.0, 0.2};
  add_motion(drive, 1, {0.02, 0.03, 0.5}, kRobot);
  EXPECT_EQ(drive.forward[0], 0.1);
  EXPECT_NEAR(drive.forward[1], 0.12, 1e-15);
  EXPECT_NEAR(drive.turn[1], 0.7, 1e-15);
  EXPECT_TRUE(drive.sideways.empty());
  EXPECT_TRUE(drive.pair.empty());
  drive.sideways = {0.0, 0.01};
  add_motion(drive, 1, {0.0, 0.03, 0.0}, kRobot);
  EXPECT_NEAR(drive.motion(1).sideways, 0.04, 1e-15);
}

/// Two wheels go on as their body does, but for a gyro's part in it.
TEST(BodyMotion, IsAddedToTwoWheelsAsTheyWouldShowIt) {
  MotionRows drive;
  drive.t = {0.1};
  testing::add_travels(drive, 0.11, 0.13, 0.4);
  add_motion(drive, 0, {0.02, 0.0, 0.5}, kRobot);
  EXPECT_NEAR(drive.pair.left[0], 0.03, 1e-15);
  EXPECT_NEAR(drive.pair.right[0], 0.25, 1e-15);
  const BodyMotion again = body_motion(drive.pair.at(0), 0.4);
  EXPECT_NEAR(again.forward, drive.forward[0], 1e-15);
  EXPECT_NEAR(again.turn, drive.turn[0], 1e-15);
  drive.gyro.emplace_back();
  add_motion(drive, 0, {0.02, 0.0, 0.5}, kRobot);
  EXPECT_NEAR(drive.pair.left[0], 0.03, 1e-15);
  EXPECT_NEAR(drive.forward[0], 0.16, 1e-15);
}

/// A wheel that stands is no less still where the motion, of which travels could be made, is
/// rounded; of other drives two wheels at the wheelbase show the motion.
TEST(BodyMotion, OwnTravelsAreThoseOfTheWheelsWhereThereAreTwo) {
  MotionRows drive;
  drive.t = {0.1};
  testing::add_travels(drive, 0.0, 0.13, 0.4);
  EXPECT_EQ(own_travel(drive, 0, kRobot).left, 0.0);
  EXPECT_EQ(own_travel(drive, 0, kRobot).right, 0.13);
  drive.pair = {};
  drive.forward = {0.1};
  drive.turn = {0.5};
  EXPECT_NEAR(own_travel(drive, 0, kRobot).left, 0.0, 1e-15);
  EXPECT_NEAR(own_travel(drive, 0, kRobot).right, 0.2, 1e-15);
  EXPECT_NEAR(mean_travel(drive.motion(0), kRobot), 0.1, 1e-15);
}

}  // namespace
}  // namespace trussmap::body_motion_test
