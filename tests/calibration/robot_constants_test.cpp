// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants to paste: signs and inverses, by robots whose wheels are known (other_drives.hpp) and
// by the table of channels written out anew.
#include "other_drives.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::robot_constants_test {
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::recorded;
using testing::with_effect;

EffectEstimate known(Channel channel, double g, double sd = 0.001) {
  return {{std::string(name_of(channel)), channel, {"1"}, {g}}, {sd}, {}};
}

double after(const RobotConstants& constants, const std::string& name) {
  for (const RobotConstant& one : constants.list) {
    if (one.name == name) return one.after;
  }
  ADD_FAILURE() << "no " << name;
  return 0.0;
}

bool has(const RobotConstants& constants, const std::string& name) {
  return std::any_of(constants.list.begin(), constants.list.end(),
                     [&name](const RobotConstant& one) { return one.name == name; });
}

double stack(const RobotConstants& constants, const std::string& key) {
  for (const StackValue& one : constants.stacks) {
    if (one.key == key) return one.value;
  }
  ADD_FAILURE() << "no " << key;
  return 0.0;
}

TEST(RobotConstants, ATravelScaleKeepsTheTurns) {
  const Model before;
  const RobotConstants found = robot_constants(before, {known(Channel::travel, 0.02)});
  EXPECT_NEAR(stack(found, "left_wheel_radius_multiplier"), 1.02, 1e-12);
  EXPECT_NEAR(stack(found, "right_wheel_radius_multiplier"), 1.02, 1e-12);
  EXPECT_NEAR(stack(found, "wheel_separation_multiplier"), 1.02, 1e-12);
  EXPECT_NEAR(stack(found, "inPerTick"), 1.02, 1e-12);
  EXPECT_NEAR(stack(found, "trackWidthTicks"), 1.0, 1e-12);
}

TEST(RobotConstants, TurningMoreIsASmallerWheelbase) {
  const RobotConstants found = robot_constants({}, {known(Channel::turn, 0.25)});
  EXPECT_NEAR(after(found, "wheelbase"), 0.34 / 1.25, 1e-12);
  EXPECT_FALSE(has(found, "left wheel"));  // nobody asked
  EXPECT_NEAR(found.list.front().sd, 0.001 * 0.34 / (1.25 * 1.25), 1e-9);
}

/// The channels of two wheels, as docs/effects.md has them, side by side; 50 draws, seed 5.
TEST(RobotConstants, TwoWheelsTurnAsTheEffectsDo) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(-0.1, 0.1);
  for (int draw = 0; draw < 50; ++draw) {
    const double l = share(random), r = share(random), w = share(random), d = share(random);
    const double f = share(random), a = share(random);
    const RobotConstants found = robot_constants(
        {}, {known(Channel::left, l), known(Channel::right, r), known(Channel::wheels, w),
             known(Channel::difference, d), known(Channel::travel, f), known(Channel::turn, a)});
    const double c_left = after(found, "left wheel");
    const double c_right = after(found, "right wheel");
    const double b = after(found, "wheelbase");
    for (const auto& [left, right] :
         {std::pair(0.1, 0.1), std::pair(-0.05, 0.05), std::pair(0.02, 0.09)}) {
      const double more_left = (w + l - 0.5 * d) * left;
      const double more_right = (w + r + 0.5 * d) * right;
      const double turn = ((right - left) * (1.0 + a) + more_right - more_left) / 0.34;
      EXPECT_NEAR((c_right * right - c_left * left) / b, turn, 1e-12);
      const double ahead = 0.5 * (left + right) * (1.0 + f) + 0.5 * (more_left + more_right);
      if (left == right) {
        EXPECT_NEAR(0.5 * (c_left * left + c_right * right), ahead, 1e-12);
      }
    }
  }
}

TEST(RobotConstants, WhatWasNotFittedIsNoFigure) {
  EffectEstimate lost = known(Channel::turn, 0.0);
  lost.not_fitted = {{0, NotFitted::undetermined, 0.0}};
  const RobotConstants found = robot_constants({}, {lost, known(Channel::gyro, 0.01)});
  ASSERT_EQ(found.list.size(), 2U);
  EXPECT_FALSE(found.list[0].determined);
  EXPECT_TRUE(found.stacks.empty());
  EXPECT_NEAR(after(found, "gyro bias"), 0.01, 1e-12);
}

TEST(RobotConstants, WhatNoConstantUndoesStaysInTheModel) {
  Effect shaped = catalogue_effect("tyre drift (t)", {0.001});
  const RobotConstants found =
      robot_constants({}, {{shaped, {0.0001}, {}}, known(Channel::gyro_scale, 0.02)});
  EXPECT_EQ(found.others, std::vector<std::string>{"tyre drift (t)"});
  EXPECT_NEAR(after(found, "gyro scale"), 1.02, 1e-12);
}

/// 5 m of it count as one before, as five after: the same variance on the way.
TEST(RobotConstants, NoiseIsPerMetreAsWheelsCountThen) {
  const Model before;
  const auto of_left_wheel = [&before](double g) {
    ModelFit fit;
    fit.model = before;
    fit.effects = {known(Channel::left, g)};
    return robot_constants(before, fit);
  };
  const RobotConstants far = of_left_wheel(4.0);
  EXPECT_NEAR(after(far, "left wheel"), 5.0, 1e-12);
  const double on_the_way = std::pow(5.0 * before.noise.left, 2) * 1.0;
  EXPECT_NEAR(std::pow(after(far, "left wheel noise"), 2) * 5.0, on_the_way, 1e-12);
  EXPECT_FALSE(has(far, "right wheel noise"));
  EXPECT_FALSE(has(of_left_wheel(0.02), "left wheel noise"));
}

/// Else a column's line would stand above "not determined" of the same name.
TEST(RobotConstants, AColumnOfTheNameOfAConstantHasALineOfItsOwn) {
  Model model;
  model.robot.drive = DriveKind::wheels;
  model.robot.columns = {"travel", "turn"};
  model.robot.matrix = Eigen::MatrixXd::Zero(3, 2);
  model.robot.matrix(0, 0) = model.robot.matrix(2, 1) = 1.0;
  const RobotConstants found =
      robot_constants(model, {known(Channel::wheel2, -0.3), known(Channel::turn, 0.25)});
  EXPECT_EQ(std::ranges::count(found.list, "turn", &RobotConstant::name), 1);
  EXPECT_TRUE(has(found, "turning"));
}

/// Ratio, wheelbase and scale of a left wheel that is 1 % larger, and of one more that is not.
TEST(RobotConstants, OneWheelExplainsThree) {
  const auto of = [](double difference, double turn, double travel) {
    return robot_constants(
        {}, {known(Channel::difference, difference, 1e-4), known(Channel::turn, turn, 2e-4),
             known(Channel::travel, travel, 2e-4)});
  };
  const RobotConstants left = of(-0.01, 0.005, 0.005);
  ASSERT_TRUE(left.one_wheel);
  EXPECT_TRUE(left.one_wheel->left);
  EXPECT_NEAR(left.one_wheel->larger, 0.01, 2.0 * left.one_wheel->sd);
  EXPECT_LT(left.one_wheel->sd, 2e-4);
  const RobotConstants right = of(-0.01, -0.005, -0.005);
  ASSERT_TRUE(right.one_wheel);
  EXPECT_FALSE(right.one_wheel->left);
  EXPECT_NEAR(right.one_wheel->larger, -0.01, 2.0 * right.one_wheel->sd);
  // A scale of both wheels leaves the wheelbase as it is.
  const RobotConstants scaled = robot_constants(
      {}, {known(Channel::difference, -0.01, 1e-4), known(Channel::wheels, 0.005, 1e-4)});
  ASSERT_TRUE(scaled.one_wheel);
  EXPECT_TRUE(scaled.one_wheel->left);
  EXPECT_NEAR(scaled.one_wheel->larger, 0.01, 2.0 * scaled.one_wheel->sd);
  EXPECT_FALSE(of(-0.01, 0.0, 0.0).one_wheel);
  EXPECT_FALSE(of(-0.01, 0.008, 0.005).one_wheel);
  EXPECT_FALSE(of(0.0, 0.005, 0.005).one_wheel);
}

TEST(RobotConstants, WheelbaseGoesIntoTheRobotOnce) {
  Model model;
  model.effects = {catalogue_effect("wheelbase", {0.25}), catalogue_effect("wheel scale", {0.02})};
  const Model once = with_wheelbase_in_robot(model);
  EXPECT_NEAR(once.robot.wheelbase, 0.34 / 1.25, 1e-12);
  EXPECT_EQ(once.effects[0].coefficients, std::vector<double>{0.0});
  EXPECT_EQ(once.effects[1].coefficients, std::vector<double>{0.02});
  EXPECT_EQ(with_wheelbase_in_robot(once).robot.wheelbase, once.robot.wheelbase);
}

class ConstantsOfDrives : public ::testing::TestWithParam<DriveKind> {};

/// The drive with the constants in it, as its software would have them; raw columns.
std::vector<Pose> reckoned(const OtherDrive& drive, Recording raw, const RobotConstants& found) {
  Robot robot = drive.model.robot;
  double aside = 1.0;
  for (const RobotConstant& one : found.list) {
    if (one.name == "wheelbase") robot.wheelbase = one.after;
    if (one.name == "length" || one.name == "radius") robot.length = one.after;
    if (one.name == "turn") robot.matrix.row(2) *= one.after;
    if (one.name == "sideways") aside = one.after;
    for (std::size_t k = 0; k < robot.columns.size(); ++k) {
      const bool rolls = robot.columns[k] == one.name || (drive.steers && k == 0);
      for (double& reading : raw.drive.covariates[k].values) {
        if (rolls && one.unit == "times" && one.name != "steering gain") reading *= one.after;
        if (drive.steers && k == 1 && one.name == "steering offset") reading += one.after;
      }
    }
  }
  DrivenRecording taken = with_wheels(std::move(raw), robot);
  for (double& left : taken.drive.sideways) left *= aside;
  return dead_reckoned_path(taken.drive, robot, drive.model.noise);
}

TEST_P(ConstantsOfDrives, PastedMakeReckoningRight) {
  const OtherDrive drive = other_drive(GetParam());
  Pose end;
  for (const testing::Twist& row : drive.rows) end = testing::after(end, row);
  for (const Channel channel : drive.constants) {
    // There the effect leaves the measured wheel's place alone, which a length does not.
    if (GetParam() == DriveKind::ackermann && channel == Channel::turn) continue;
    const double g = channel == Channel::steer ? 0.03 : -0.05;
    const Recording raw = recorded(drive, with_effect(drive, channel, g));
    const auto error = [&](const RobotConstants& found) {
      const Pose at = reckoned(drive, raw, found).back();
      return std::hypot(at.x - end.x, at.y - end.y) + std::abs(at.heading - end.heading);
    };
    const double nominal = error({});
    EXPECT_GT(nominal, 0.02) << name_of(channel);
    const RobotConstants found = robot_constants(drive.model, {known(channel, g)});
    EXPECT_LT(error(found), 1e-9) << name_of(channel);
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, ConstantsOfDrives,
                         ::testing::Values(DriveKind::skid_steer, DriveKind::tricycle,
                                           DriveKind::ackermann, DriveKind::omni3,
                                           DriveKind::mecanum, DriveKind::wheels),
                         [](const auto& one) {
                           std::string name(name_of(one.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace trussmap::robot_constants_test
