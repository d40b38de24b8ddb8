// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheels of every drive against the motion of their contact points, as a rigid body has it.
#include "other_drives.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::wheel_kinematics_test {
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::Twist;
using testing::way_along;

const std::vector<Twist>& twists(bool to_the_side) {
  static const std::vector<Twist> omni{{0.3, 0.1, 0.2}, {-0.2, 0.4, -0.1}, {0.0, -0.3, 0.0}};
  static const std::vector<Twist> bound{{0.3, 0.0, 0.2}, {0.4, 0.0, -0.1}, {0.25, 0.0, 0.0}};
  return to_the_side ? omni : bound;
}

Recording recording_of(const std::vector<std::string>& columns,
                       const std::vector<std::vector<double>>& readings) {
  Recording recording;
  recording.name = "drive";
  for (std::size_t row = 0; row < readings.front().size(); ++row) {
    recording.drive.t.push_back(static_cast<double>(row));
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    recording.drive.covariates.push_back({columns[k], readings[k]});
  }
  return recording;
}

void expect_motion(const MotionRows& drive, const std::vector<Twist>& expected) {
  for (std::size_t row = 0; row < expected.size(); ++row) {
    EXPECT_NEAR(drive.forward[row], expected[row].f, 1e-14);
    EXPECT_NEAR(drive.slip(row), expected[row].s, 1e-14);
    EXPECT_NEAR(drive.turn[row], expected[row].a, 1e-13);
  }
}

/// by_reading against differences of what a slightly other reading makes of the row.
void expect_derivatives(const Recording& recording, const Robot& robot) {
  constexpr double kStep = 1e-6;
  const DrivenRecording here = with_wheels(recording, robot);
  for (std::size_t k = 0; k < robot.columns.size(); ++k) {
    Recording more = recording;
    Recording less = recording;
    for (double& one : more.drive.covariates[k].values) one += kStep;
    for (double& one : less.drive.covariates[k].values) one -= kStep;
    const MotionRows up = with_wheels(more, robot).drive;
    const MotionRows down = with_wheels(less, robot).drive;
    for (std::size_t row = 0; row < up.rows(); ++row) {
      const std::array<double, 3>& by = here.drive.wheels[k].by_reading[row];
      EXPECT_NEAR(by[0], (up.forward[row] - down.forward[row]) / (2.0 * kStep), 1e-8);
      EXPECT_NEAR(by[1], (up.slip(row) - down.slip(row)) / (2.0 * kStep), 1e-8);
      EXPECT_NEAR(by[2], (up.turn[row] - down.turn[row]) / (2.0 * kStep), 1e-7);
    }
  }
}

class WheelKinematics : public ::testing::TestWithParam<DriveKind> {};

TEST_P(WheelKinematics, ContactPointsGiveTheBodysMotionBack) {
  const OtherDrive drive = other_drive(GetParam());
  const Robot& robot = drive.model.robot;
  const std::vector<Twist>& bodies =
      twists(GetParam() == DriveKind::omni3 || GetParam() == DriveKind::mecanum);
  std::vector<std::vector<double>> readings(robot.columns.size());
  for (const Twist& body : bodies) {
    const std::vector<double> shown = drive.wheels(body);
    for (std::size_t k = 0; k < readings.size(); ++k) readings[k].push_back(shown[k]);
  }
  const Recording recording = recording_of(robot.columns, readings);
  expect_motion(with_wheels(recording, robot).drive, bodies);
  expect_derivatives(recording, robot);
}

INSTANTIATE_TEST_SUITE_P(Drives, WheelKinematics,
                         ::testing::Values(DriveKind::skid_steer, DriveKind::tricycle,
                                           DriveKind::ackermann, DriveKind::omni3,
                                           DriveKind::mecanum),
                         [](const auto& one) {
                           std::string name(name_of(one.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST(WheelColumns, SkidSteerTakesTheMeansOfItsSides) {
  Robot robot;
  robot.drive = DriveKind::skid_steer;
  robot.wheelbase = 0.8;
  robot.columns = {"fl", "rl", "fr", "rr"};
  const Recording recording = recording_of(robot.columns, {{0.1}, {0.3}, {0.5}, {0.7}});
  const MotionRows drive = with_wheels(recording, robot).drive;
  EXPECT_NEAR(drive.forward[0], 0.4, 1e-15);  // of 0.2 and 0.6 m
  EXPECT_NEAR(drive.turn[0], 0.5, 1e-15);
  EXPECT_TRUE(drive.pair.empty());
  EXPECT_TRUE(drive.sideways.empty());
  expect_derivatives(recording, robot);
}

TEST(WheelColumns, AnyWheelsAtAnyPlaces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int round = 0; round < 20; ++round) {
    Robot robot;
    robot.drive = DriveKind::wheels;
    std::vector<std::vector<double>> readings;
    for (int k = 0; k < 5; ++k) {
      const WheelPlace place{draw(random), draw(random), 3.0 * draw(random), draw(random)};
      robot.places.push_back(place);
      robot.columns.push_back("w" + std::to_string(k));
      readings.emplace_back();
      for (const Twist& body : twists(true)) {
        readings.back().push_back(
            way_along(body, place.x, place.y, place.direction + place.roller) /
            std::cos(place.roller));
      }
    }
    robot.matrix = wheel_matrix(robot.places);
    const Recording recording = recording_of(robot.columns, readings);
    const MotionRows drive = with_wheels(recording, robot).drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      EXPECT_NEAR(drive.forward[row], twists(true)[row].f, 1e-11);
      EXPECT_NEAR(drive.slip(row), twists(true)[row].s, 1e-11);
    }
  }
}

TEST(WheelColumns, ParallelTrackingWheelsLeaveNoWayToTheSide) {
  const Eigen::MatrixXd M = wheel_matrix({{0.1, 0.2, 0.0, 0.0}, {-0.1, -0.3, 0.0, 0.0}});
  EXPECT_TRUE(M.row(1).isZero(0.0));
  const Eigen::Vector3d straight = M * Eigen::Vector2d(0.5, 0.5);
  EXPECT_NEAR(straight[0], 0.5, 1e-15);
  EXPECT_NEAR(straight[2], 0.0, 1e-15);
}

TEST(WheelColumns, WhatShowsTooLittleIsRefused) {
  EXPECT_THROW(static_cast<void>(wheel_matrix({{0, 0.2, 0, 0}, {0.1, 0.2, 0, 0}})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(wheel_matrix({{0, 0.2, 0, 0}, {0.1, 0.2, 1.0, 0}})),
               std::invalid_argument);
}

TEST(WheelColumns, TwoNamedWheelsAreADifferentialDrive) {
  Robot robot;
  robot.columns = {"port", "starboard"};
  const MotionRows drive =
      with_wheels(recording_of({"port", "starboard"}, {{0.1, 0.2}, {0.3, 0.4}}), robot).drive;
  EXPECT_EQ(drive.pair.left, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(drive.pair.right, (std::vector<double>{0.3, 0.4}));
  EXPECT_NEAR(drive.forward[1], 0.3, 1e-15);
  EXPECT_NEAR(drive.turn[1], 0.2 / 0.34, 1e-15);
  robot.wheelbase = 0.0;
  EXPECT_THROW(
      static_cast<void>(with_wheels(recording_of({"port", "starboard"}, {{0.1}, {0.3}}), robot)),
      std::invalid_argument);
  EXPECT_TRUE(drive.wheels.empty());
}

Robot unicycle(const std::vector<std::string>& columns) {
  Robot robot;
  robot.drive = DriveKind::unicycle;
  robot.columns = columns;
  return robot;
}

TEST(Unicycle, MovesAsItsColumnsSay) {
  const Robot robot = unicycle({"v", "w"});
  const Recording recording = recording_of({"v", "w"}, {{0.1, -0.2, 0.0}, {0.3, 0.0, -2.0}});
  expect_motion(with_wheels(recording, robot).drive,
                {{0.1, 0.0, 0.3}, {-0.2, 0.0, 0.0}, {0.0, 0.0, -2.0}});
}

TEST(Unicycle, OfTravelAloneTurnsByItsGyro) {
  const Robot robot = unicycle({"v"});
  Recording recording = recording_of({"v"}, {{0.1, 0.2, 0.0}});
  EXPECT_THROW((void)with_wheels(recording, robot), InputError);  // no gyro
  recording.drive.yaw_rate = {0.5, -0.25, 1.0};
  const double dt = recording.drive.duration(0);
  const MotionRows drive = with_wheels(recording, robot).drive;
  expect_motion(drive, {{0.1, 0.0, 0.5 * dt}, {0.2, 0.0, -0.25 * dt}, {0.0, 0.0, dt}});
  EXPECT_FALSE(drive.has_gyro());  // it is no sensor beside the wheels
  recording.drive.yaw_rate[1] = kAbsent;
  EXPECT_THROW((void)with_wheels(recording, robot), InputError);
}

std::string refusal(const Recording& recording, const Robot& robot) {
  try {
    static_cast<void>(with_wheels(recording, robot));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(WheelColumns, AMissingColumnIsNamed) {
  Robot robot;
  robot.drive = DriveKind::tricycle;
  robot.length = 1.0;
  robot.columns = {"wheel", "steer"};
  EXPECT_EQ(
      refusal(recording_of({"wheel", "angle"}, {{0.1}, {0.0}}), robot),
      "drive/drive.csv: has no column \"steer\", which the model's [robot] names, expected one "
      "of wheel, angle");
  EXPECT_EQ(refusal(recording_of({"wheel", "angle"}, {{0.1}, {0.0}}), Robot()),
            "drive/drive.csv: has no columns left and right, expected them, or a model whose "
            "[robot] says which drive wheel, angle are of");
}

TEST(WheelColumns, AnImpossibleSteeringAngleIsRefused) {
  Robot robot;
  robot.drive = DriveKind::ackermann;
  robot.length = 1.0;
  robot.columns = {"wheel", "steer"};
  EXPECT_NE(refusal(recording_of({"wheel", "steer"}, {{0.1, 0.1}, {0.0, 1.6}}), robot)
                .find("a steering angle of 1.6 rad at t = 1 s"),
            std::string::npos);
}

TEST(WheelColumns, NamesComeBack) {
  for (const DriveKind drive :
       {DriveKind::differential, DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
        DriveKind::omni3, DriveKind::mecanum, DriveKind::wheels}) {
    EXPECT_EQ(drive_named(name_of(drive)), drive);
  }
  EXPECT_THROW(static_cast<void>(drive_named("hover")), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::wheel_kinematics_test
