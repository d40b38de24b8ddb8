// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives with other wheels than two, from their columns to a fit, on drives whose truth is known.
#include "other_drives.hpp"

#include "drive/row_variables.hpp"
#include "effects/channel_physics.hpp"
#include "estimation/segment_motion.hpp"
#include "fit/effect_columns.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::other_drives_test {
using namespace estimation;
namespace {

using testing::after;
using testing::noisy;
using testing::other_drive;
using testing::OtherDrive;
using testing::recorded;
using testing::Twist;
using testing::with_effect;

/// Of all drives that are none of two wheels.
constexpr DriveKind kDrives[] = {DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
                                 DriveKind::omni3,      DriveKind::mecanum,  DriveKind::wheels};

DrivenRecording driven_by(const OtherDrive& drive, const testing::Wheels& wheels) {
  return with_wheels(recorded(drive, wheels), drive.model.robot);
}

class OtherDrives : public ::testing::TestWithParam<DriveKind> {};

TEST_P(OtherDrives, NoiseFreeEffectsAreFoundAndLeaveNothing) {
  const OtherDrive drive = other_drive(GetParam());
  EXPECT_LT(fit_model({driven_by(drive, drive.wheels)}, drive.model).chi2, 1e-6);
  for (const Channel channel : drive.constants) {
    Model model = drive.model;
    const double g = channel == Channel::steer ? 0.03 : -0.02;
    const DrivenRecording recording = driven_by(drive, with_effect(drive, channel, g));
    EXPECT_GT(fit_model({recording}, model).chi2, 20.0) << name_of(channel);
    model.effects.push_back({"hidden", channel, {"1"}, {}, false});
    const ModelFit fit = fit_model({recording}, model);
    EXPECT_LT(fit.chi2, 1e-6) << name_of(channel);
    EXPECT_NEAR(fit.model.effects.front().coefficients.front(), g, 1e-6) << name_of(channel);
  }
}

INSTANTIATE_TEST_SUITE_P(Unicycle, OtherDrives, ::testing::Values(DriveKind::unicycle));

INSTANTIATE_TEST_SUITE_P(Drives, OtherDrives, ::testing::ValuesIn(kDrives), [](const auto& one) {
  std::string name(name_of(one.param));
  std::erase(name, '-');
  return name;
});

/// Whose steered wheel stands at (1 + gain) times what it says, and `offset` further left.
testing::Wheels misread(const testing::Wheels& wheels, double offset, double gain) {
  return [wheels, offset, gain](const Twist& row) {
    std::vector<double> shown = wheels(row);
    shown[1] = (shown[1] - offset) / (1.0 + gain);
    return shown;
  };
}

TEST(Steering, IsTakenInExactlyHoweverFarOff) {
  for (const DriveKind kind : {DriveKind::tricycle, DriveKind::ackermann}) {
    const OtherDrive drive = other_drive(kind);
    Model model = drive.model;
    model.effects = {{"offset", Channel::steer, {"1"}, {}, false},
                     {"gain", Channel::steer_gain, {"1"}, {}, false}};
    const DrivenRecording recording = driven_by(drive, misread(drive.wheels, 0.2, 0.3));
    const ModelFit fit = fit_model({recording}, model);
    EXPECT_LT(fit.chi2, 1e-6) << name_of(kind);
    EXPECT_NEAR(fit.model.effects[0].coefficients[0], 0.2, 1e-6) << name_of(kind);
    EXPECT_NEAR(fit.model.effects[1].coefficients[0], 0.3, 1e-6) << name_of(kind);
    // Dead reckoning by the fitted model ends where the robot was.
    Pose end;
    for (const Twist& row : drive.rows) end = after(end, row);
    const PoseEstimate reckoned = dead_reckoned_poses(recording, fit.model).back().estimate;
    EXPECT_LT((reckoned.pose.position() - end.position()).norm(), 1e-5) << name_of(kind);
  }
}

/// Shapes see what was read, so that what they multiply does not depend on a coefficient.
TEST(Steering, LeavesShapesAsTheyWereRead) {
  const OtherDrive drive = other_drive(DriveKind::tricycle);
  Model model = drive.model;
  model.effects = {{"offset", Channel::steer, {"1"}, {0.2}, false}};
  const DrivenRecording recording = driven_by(drive, drive.wheels);
  const std::vector<DrivenRecording> steered_ones =
      fitting::steered({recording}, model.effects, model.robot, {});
  const MotionRows& turned = steered_ones.front().drive;
  ASSERT_NE(turned.turn, recording.drive.turn);
  const std::vector<Pose> path(turned.rows());
  const RowVariables before = drive::row_variables(recording.drive, model.robot, Pose(), path, 0);
  const RowVariables now = drive::row_variables(turned, model.robot, Pose(), path, 0);
  for (const auto& [name, values] : before) {
    for (std::size_t row = 0; row < values.size(); ++row) {
      ASSERT_NEAR(now.at(name)[row], values[row], 1e-12) << name;
    }
  }
}

/// Per segment, what a channel's column says against what slightly other readings of the columns
/// lead to.
TEST(OtherDrivesColumns, AreThoseOfDifferences) {
  constexpr double kStep = 1e-5;
  for (const DriveKind kind : kDrives) {
    const OtherDrive drive = other_drive(kind);
    const Robot& robot = drive.model.robot;
    const Recording raw = recorded(drive, drive.wheels);
    const MotionRows here = with_wheels(raw, robot).drive;
    std::vector<Channel> channels;
    for (const ChannelFacts& one : trussmap::channels()) {
      const bool steers = one.channel == Channel::steer || one.channel == Channel::steer_gain;
      if ((wheel_of(one.channel) || steers) && effects::is_of_drive(one.channel, robot)) {
        channels.push_back(one.channel);
      }
    }
    EXPECT_EQ(channels.size(), robot.columns.size());
    for (const Channel channel : channels) {
      const auto end = [&](double g) {
        Recording other = raw;
        const std::size_t k = wheel_of(channel).value_or(1);
        for (double& one : other.drive.covariates[k].values) {
          one = channel == Channel::steer ? one + g : one * (1.0 + g);
        }
        const MotionRows moved = with_wheels(other, robot).drive;
        const SegmentMotion motion = segment_motion(segment_rows(moved, 5.0, 17.3));
        const Pose& d = motion.displacement;
        return Eigen::Vector3d(d.x, d.y, d.heading);
      };
      const Eigen::Vector3d expected =
          (8.0 * (end(kStep) - end(-kStep)) - end(2.0 * kStep) + end(-2.0 * kStep)) /
          (12.0 * kStep);
      std::vector<effects::DrivePattern> patterns;
      for (std::size_t row = 0; row < here.rows(); ++row) {
        patterns.push_back(
            effects::drive_pattern(channel, 1.0, drive::shown_motion(here, row, robot)));
      }
      const SegmentWithEffects found =
          segment_motion(segment_rows(here, 5.0, 17.3), {&patterns}, Eigen::VectorXd::Zero(1));
      EXPECT_LT((found.derivatives.col(0).head<3>() - expected).norm(), 1e-6 * expected.norm())
          << name_of(channel);
    }
  }
}

TEST_P(OtherDrives, DeadReckoningScattersAsItsCovarianceSays) {
  constexpr int kTimes = 400;
  std::mt19937_64 random(19);
  OtherDrive drive = other_drive(GetParam());
  Noise& noise = drive.model.noise;
  noise.left = noise.right = 0.004;
  noise.steer = 0.003;
  Pose end;
  for (const Twist& row : drive.rows) end = after(end, row);
  double sum = 0.0;
  for (int k = 0; k < kTimes; ++k) {
    const DrivenRecording recording = driven_by(drive, noisy(drive, drive.wheels, random));
    const PoseEstimate found =
        dead_reckoned_estimates(recording.drive, drive.model.robot, noise).back();
    const Eigen::Vector3d error(found.pose.x - end.x, found.pose.y - end.y,
                                wrap_angle(found.pose.heading - end.heading));
    sum += error.dot(found.covariance.inverse() * error);
  }
  // Of chi-square(3): mean 3, standard deviation sqrt 6.
  EXPECT_NEAR(sum / kTimes, 3.0, 4.0 * std::sqrt(6.0 / kTimes));
}

TEST_P(OtherDrives, FitsHaveTheChiSquareOfTheirDegreesOfFreedom) {
  constexpr int kTimes = 20;
  std::mt19937_64 random(23);
  std::normal_distribution<double> normal;
  OtherDrive drive = other_drive(GetParam());
  Noise& noise = drive.model.noise;
  noise.left = noise.right = 0.004;
  noise.steer = 0.003;
  double chi2 = 0.0;
  double dof = 0.0;
  for (int k = 0; k < kTimes; ++k) {
    DrivenRecording recording = driven_by(drive, noisy(drive, drive.wheels, random));
    for (TruthRow& row : recording.truth) {
      row.x += noise.truth * normal(random);
      row.y += noise.truth * normal(random);
      row.heading += noise.truth_heading * normal(random);
    }
    const ModelFit fit = fit_model({recording}, drive.model);
    chi2 += fit.chi2;
    dof += fit.dof;
  }
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

TEST(OtherDrivesCalibration, FindsEachDrivesConstants) {
  std::mt19937_64 random(29);
  for (const DriveKind kind : {DriveKind::omni3, DriveKind::tricycle}) {
    OtherDrive drive = other_drive(kind);
    Model& model = drive.model;
    model.noise.left = model.noise.right = 0.002;
    model.noise.steer = 0.002;
    const Channel channel = drive.steers ? Channel::steer : Channel::wheel2;
    const DrivenRecording recording =
        driven_by(drive, noisy(drive, with_effect(drive, channel, 0.02), random));
    const WheelCalibration found = calibrate_wheels({recording}, model);
    EXPECT_FALSE(found.diameter_ratio || found.wheelbase_ratio || found.scale);
    ASSERT_EQ(found.constants.size(), drive.steers ? 4U : 6U);
    for (const DriveConstant& one : found.constants) {
      const double expected = one.channel == channel ? 0.02 : 0.0;
      EXPECT_NEAR(one.g.value, expected, 4.0 * one.g.sd) << name_of(one.channel);
      EXPECT_LT(one.g.sd, 0.01);
    }
  }
}

/// What says how far it went, and how far it turned, has a factor of each, and a bias of its turns:
/// a unicycle, or columns that do.
TEST(OtherDrivesCalibration, FindsTheFactorsAndTheBiasOfTurnsThatAreSaid) {
  constexpr double kTravel = 0.04;
  constexpr double kTurn = -0.1;
  constexpr double kBias = 0.02;  // rad/s, by which it says too much
  std::mt19937_64 random(37);
  OtherDrive drive = other_drive(DriveKind::unicycle);
  drive.model.noise.left = drive.model.noise.right = 0.002;
  const testing::Wheels shown = [](const Twist& row) {
    return std::vector<double>{row.f / (1.0 + kTravel),
                               row.a / (1.0 + kTurn) + kBias * testing::kOtherRow};
  };
  Recording recording = recorded(drive, noisy(drive, shown, random));
  Model columns = drive.model;
  columns.robot.drive = DriveKind::wheels;
  columns.robot.matrix = Eigen::MatrixXd::Zero(3, 2);
  columns.robot.matrix(0, 0) = columns.robot.matrix(2, 1) = 1.0;
  for (const Model& model : {drive.model, columns}) {
    const WheelCalibration found = calibrate_wheels({with_wheels(recording, model.robot)}, model);
    EXPECT_TRUE(found.undetermined.empty());
    ASSERT_EQ(found.constants.size(), 3U);
    for (const DriveConstant& one : found.constants) {
      const double expected = one.channel == Channel::turn    ? kTurn
                              : one.channel == Channel::drift ? -kBias * (1.0 + kTurn)
                                                              : kTravel;
      EXPECT_NEAR(one.g.value, expected, 4.0 * one.g.sd) << name_of(one.channel);
      EXPECT_LT(one.g.sd, one.channel == Channel::drift ? 0.002 : 0.01) << name_of(one.channel);
    }
    const std::vector<RobotConstant> list = robot_constants(model, found).list;
    const auto bias = std::ranges::find(list, "turn bias", &RobotConstant::name);
    ASSERT_NE(bias, list.end());
    EXPECT_NEAR(bias->after, kBias, 4.0 * bias->sd);
  }
}

/// A stated gain that is a sixth of the true one is no start for least squares.
TEST(OtherDrivesCalibration, FindsASteeringThatIsGeared) {
  const OtherDrive drive = other_drive(DriveKind::tricycle);
  std::mt19937_64 random(31);
  const DrivenRecording recording =
      driven_by(drive, misread(noisy(drive, drive.wheels, random), -0.06, 4.7));
  const WheelCalibration found = calibrate_wheels({recording}, drive.model);
  EXPECT_TRUE(found.settled);
  EXPECT_TRUE(found.undetermined.empty());
  for (const DriveConstant& one : found.constants) {
    const double expected = one.channel == Channel::steer_gain ? 4.7
                            : one.channel == Channel::steer    ? -0.06
                                                               : 0.0;
    EXPECT_NEAR(one.g.value, expected, 4.0 * one.g.sd) << name_of(one.channel);
    EXPECT_LT(one.g.sd, one.channel == Channel::steer_gain ? 0.15 : 0.02);
  }
}

/// Three omni wheels that roll up to a degree beside their stated directions, one arm 3 % longer,
/// tracked at a point beside the centre by a truth that is turned: another drive of the same robot
/// ends where it should, to what the wheels' second order leaves.
TEST(OtherDrivesCalibration, WheelsThatRollInOtherDirectionsAreReckonedAway) {
  constexpr double kRadius = 0.2;
  OtherDrive drive = other_drive(DriveKind::omni3);
  const testing::Wheels wheels = [](const Twist& row) {
    const std::array<double, 3> at{-M_PI / 3.0, M_PI / 3.0, M_PI};
    const std::array<double, 3> beside{0.008, -0.012, 0.017};  // rad
    const std::array<double, 3> arm{kRadius, 1.03 * kRadius, kRadius};
    std::vector<double> shown;
    for (std::size_t n = 0; n < 3; ++n) {
      shown.push_back(testing::way_along(row, arm[n] * std::cos(at[n]), arm[n] * std::sin(at[n]),
                                         at[n] - M_PI / 2.0 + beside[n]));
    }
    return shown;
  };
  const auto tracked = [&wheels](const OtherDrive& one) {
    DrivenRecording recording = driven_by(one, wheels);
    for (TruthRow& row : recording.truth) {
      const Pose point = compose({row.x, row.y, row.heading}, {0.03, -0.02, 0.01});
      row = {row.t, point.x, point.y, wrap_angle(point.heading)};
    }
    return recording;
  };
  const DrivenRecording seen = tracked(drive);
  OtherDrive other = drive;
  for (Twist& row : other.rows) row = {0.5 * row.s, row.f, -1.3 * row.a};
  const DrivenRecording unseen = tracked(other);
  const WheelCalibration found = calibrate_wheels({seen}, drive.model);
  EXPECT_TRUE(found.undetermined.empty());
  const double nominal = drive_errors({unseen}, drive.model).front().end;
  EXPECT_GT(nominal, 0.1);
  EXPECT_LT(drive_errors({unseen}, found.model, found.truth).front().end, 0.05 * nominal);
}

}  // namespace
}  // namespace trussmap::other_drives_test
