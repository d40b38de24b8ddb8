// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A truth whose heading is turned, or counted clockwise, is told by the way that the robot went;
// where it makes the wheels absurd the calibration is refused.
#include "calibration/heading_offset.hpp"

#include "driven.hpp"
#include "estimation/drawn_drive.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::heading_offset_test {
using namespace calibration;
namespace {

using testing::draw;
using testing::DrawnRobot;
using testing::figure;

constexpr double kPi = std::numbers::pi;

DrawnRobot usual() {
  DrawnRobot robot;
  robot.truth_sd = 0.002;
  robot.truth_heading_sd = 0.005;
  return robot;
}

Recording turned(double angle) {
  DrawnRobot robot = usual();
  robot.heading = angle;
  return draw(figure(), robot);
}

Recording clockwise() {
  Recording recording = turned(0.0);
  for (TruthRow& row : recording.truth) row.heading = -row.heading;
  return recording;
}

std::string refusal(const Recording& recording) {
  try {
    static_cast<void>(calibrate_wheels({recording}, Model()));
  } catch (const SolveError& error) {
    return error.what();
  }
  return "";
}

TEST(HeadingOffset, IsTheAngleThatTheTruthIsTurnedBy) {
  for (const double angle : {-2.0, -0.5, 0.0, 0.3, 1.6, 3.0}) {
    const HeadingOffset found = heading_offset({testing::driven(turned(angle))});
    // Pairs of rows 0.2 m apart, each off by 0.002 m x sqrt(2) / 0.2 m; 150 of them.
    EXPECT_NEAR(found.angle, angle, 4.0 * 0.015 / std::sqrt(150.0)) << angle;
    EXPECT_GT(found.agreement, 0.99);
    EXPECT_FALSE(found.clockwise);
  }
}

TEST(HeadingOffset, DrivingBackwardsIsNoTurn) {
  const Recording reverse = draw({{1.0, 0.0, 0.0}, {8.0, -0.5, 0.2}, {1.0, 0.0, 0.0}}, usual());
  EXPECT_NEAR(heading_offset({testing::driven(reverse)}).angle, 0.0, 0.02);
  EXPECT_EQ(describe(heading_offset({testing::driven(reverse)})), "");
}

TEST(HeadingOffset, ClockwiseHeadingsAreKnown) {
  const HeadingOffset found = heading_offset({testing::driven(clockwise())});
  EXPECT_TRUE(found.clockwise);
  EXPECT_GT(found.agreement, 0.99);
  EXPECT_NEAR(found.angle, 0.0, 0.02);
}

TEST(HeadingOffset, ARobotThatGoesNowhereTellsNothing) {
  const Recording spin = draw({{1.0, 0.0, 0.0}, {10.0, 0.0, 0.5}}, usual());
  EXPECT_EQ(heading_offset({testing::driven(spin)}).agreement, 0.0);
}

TEST(WheelCalibration, ATruthThatIsTurnedRoundIsRefusedAndNamed) {
  const std::string said = refusal(turned(kPi));
  EXPECT_EQ(said.rfind("not calibrated: E_", 0), 0U) << said;
  EXPECT_NE(said.find("which no robot has"), std::string::npos) << said;
  EXPECT_NE(said.find("turned by 3.1"), std::string::npos) << said;
  EXPECT_NE(said.find("(180 degrees) against the direction of travel"), std::string::npos) << said;
}

TEST(WheelCalibration, ClockwiseTruthIsRefusedAndNamed) {
  const std::string said = refusal(clockwise());
  EXPECT_NE(said.find("the truth's headings look clockwise"), std::string::npos) << said;
}

TEST(WheelCalibration, ExchangedWheelsAreRefused) {
  Recording recording = turned(0.0);
  std::swap(recording.drive.left, recording.drive.right);
  const std::string said = refusal(recording);
  EXPECT_EQ(said.rfind("not calibrated: E_b (wheelbase / nominal) would be -", 0), 0U) << said;
  EXPECT_NE(said.find("are left and right exchanged"), std::string::npos) << said;
}

TEST(WheelCalibration, ATruthThatIsTurnedALittleIsFound) {
  const WheelCalibration found = calibrate_wheels({turned(0.4)}, Model());
  EXPECT_NEAR(found.truth.heading, 0.4, 0.02);
  EXPECT_NEAR(found.wheelbase_ratio->value, 1.0, 0.01);
  EXPECT_NEAR(found.scale->value, 1.0, 0.01);
}

}  // namespace
}  // namespace trussmap::heading_offset_test
