// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation.hpp"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::tape_robot_test {
namespace {

TEST(TapeRobot, APerfectOneEndsWhereItThinks) {
  std::mt19937_64 unused;
  const TestPath path = {{2.0, 0.3}, {0.0, -1.0}, {-1.0, 0.0}, {0.5, 7.0}};
  const Pose end = drive_once(misbuilt_robot(0.4, 1.0, 1.0), path, unused);
  EXPECT_EQ(end.x, 0.0);
  EXPECT_EQ(end.y, 0.0);
  EXPECT_EQ(end.heading, 0.0);
}

TEST(TapeRobot, AWiderOneTurnsLessByTheRatio) {
  std::mt19937_64 unused;
  const Pose end = drive_once(misbuilt_robot(0.4, 1.0, 1.25), {{0.0, 1.0}}, unused);
  EXPECT_NEAR(end.heading, 1.0 / 1.25 - 1.0, 1e-15);
  // A right wheel that runs 2 % farther over 3 m turns the robot by 0.06 m over the wheelbase.
  TapeRobot robot;
  robot.right_share = 1.02;
  EXPECT_NEAR(drive_once(robot, {{3.0, 0.0}}, unused).heading, 0.06 / 0.34, 1e-15);
}

TEST(TapeRobot, ReprogrammingWithTheTruthMakesItPerfect) {
  std::mt19937_64 unused;
  const TapeRobot robot = misbuilt_robot(0.4, 1.03, 0.9);
  const TapeRobot right = reprogrammed(robot, 2.0 / 2.03, 2.06 / 2.03, 0.36);
  const Pose end = drive_once(right, square_path(4.0, Direction::cw), unused);
  EXPECT_LT(std::hypot(end.x, end.y), 1e-12);
  EXPECT_LT(std::abs(end.heading), 1e-12);
}

TEST(TapeRobot, ItsNoiseIsThatOfItsWheelsAtAnyStep) {
  // Straight on: the wheels' travels have variance k^2 D, the centre a quarter of their sum, the
  // heading their sum over B^2. 20000 runs are sure to sqrt(2/20000) = 1 % of a variance.
  for (const double step : {0.05, 0.7}) {
    TapeRobot robot;
    robot.left_noise = 0.001;
    robot.right_noise = 0.002;
    robot.step = step;
    std::mt19937_64 random(1);
    double xx = 0.0;
    double hh = 0.0;
    for (const Pose& end : drive_often(robot, {{2.0, 0.0}}, 20000, random)) {
      xx += end.x * end.x / 20000.0;
      hh += end.heading * end.heading / 20000.0;
    }
    const double sum = 2.0 * (0.001 * 0.001 + 0.002 * 0.002);
    EXPECT_NEAR(xx / (sum / 4.0), 1.0, 0.04) << step;
    EXPECT_NEAR(hh / (sum / (0.34 * 0.34)), 1.0, 0.04) << step;
  }
}

TEST(TapeRobot, TheTapeAddsItsOwnErrorOncePerRun) {
  TapeRobot robot;
  robot.tape_sd = 0.02;
  robot.tape_heading_sd = 0.01;
  std::mt19937_64 random(2);
  double xx = 0.0;
  double hh = 0.0;
  for (const Pose& end : drive_often(robot, square_path(4.0, Direction::ccw), 20000, random)) {
    xx += end.x * end.x / 20000.0;
    hh += end.heading * end.heading / 20000.0;
  }
  EXPECT_NEAR(std::sqrt(xx), 0.02, 4 * 0.005 * 0.02);
  EXPECT_NEAR(std::sqrt(hh), 0.01, 4 * 0.005 * 0.01);
}

TEST(TapeRobot, RefusesNoWheelbase) {
  std::mt19937_64 random(3);
  TapeRobot robot;
  robot.wheelbase = 0.0;
  EXPECT_THROW((void)drive_once(robot, {{1.0, 0.0}}, random), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::tape_robot_test
