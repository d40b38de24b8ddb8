// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/body_motion.hpp"

#include "drive/row_motion.hpp"

#include <random>

#include <gtest/gtest.h>

namespace trussmap::body_motion_test {
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
    const BodyMotion again = body_motion(wheels, kRobot);
    EXPECT_NEAR(again.forward, motion.forward, 1e-15);
    EXPECT_NEAR(again.turn, motion.turn, 1e-14);
  }
}

TEST(BodyMotion, IsAddedToTheSideOnlyWhereADriveGoesThere) {
  MotionRows drive;
  drive.t = {0.1, 0.2};
  drive.left = drive.right = {0.1, 0.1};
  add_motion(drive, 1, {0.02, 0.03, 0.5}, kRobot);
  EXPECT_EQ(drive.left[0], 0.1);
  EXPECT_NEAR(drive.left[1], 0.02, 1e-15);
  EXPECT_NEAR(drive.right[1], 0.22, 1e-15);
  EXPECT_TRUE(drive.sideways.empty());
  drive.sideways = {0.0, 0.01};
  add_motion(drive, 1, {0.0, 0.03, 0.0}, kRobot);
  EXPECT_NEAR(body_motion(drive, 1, kRobot).sideways, 0.04, 1e-15);
}

TEST(RowMotion, HasWhatAnErrorOfEachWheelDoes) {
  const double step = 1e-3;
  const RowMotion row = row_motion({0.11, 0.13}, 0.0, 0.1, kRobot);
  const BodyMotion left = row_motion({0.11 + step, 0.13}, 0.0, 0.1, kRobot).body;
  const BodyMotion right = row_motion({0.11, 0.13 + step}, 0.0, 0.1, kRobot).body;
  EXPECT_NEAR(row.by_wheels(step, 0.0).forward, left.forward - row.body.forward, 1e-15);
  EXPECT_NEAR(row.by_wheels(step, 0.0).turn, left.turn - row.body.turn, 1e-15);
  EXPECT_NEAR(row.by_wheels(0.0, step).forward, right.forward - row.body.forward, 1e-15);
  EXPECT_NEAR(row.by_wheels(0.0, step).turn, right.turn - row.body.turn, 1e-15);
}

}  // namespace
}  // namespace trussmap::body_motion_test
