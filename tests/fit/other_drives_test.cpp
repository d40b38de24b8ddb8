// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives with other wheels than two, from their columns to a fit, on drives whose truth is known.
#include "effects/channel_physics.hpp"
#include "estimation/segment_motion.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/fit_model.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

struct Twist {
  double f = 0.0;  // m ahead in a row
  double s = 0.0;  // m to the left
  double a = 0.0;  // rad
};

/// What each column shows of a row.
using Wheels = std::function<std::vector<double>(const Twist&)>;

constexpr double kSmall = 1e-12;

/// 60 s of bends, turns both ways and, where it can, ways to the side.
std::vector<Twist> driven(bool to_the_side) {
  std::vector<Twist> rows;
  for (int k = 0; k < 600; ++k) {
    const double t = 0.1 * k;
    rows.push_back({0.03 + 0.01 * std::sin(0.31 * t),
                    to_the_side ? 0.02 * std::sin(0.17 * t + 1.0) : 0.0,
                    0.025 * std::sin(0.23 * t) + 0.01 * std::cos(0.71 * t)});
  }
  return rows;
}

Pose next(const Pose& pose, const Twist& row) {
  const double half = 0.5 * row.a;
  const double chord = std::abs(half) < kSmall ? 1.0 : std::sin(half) / half;
  const Vector2 step = chord * (rotation(pose.heading + half) * Vector2(row.f, row.s));
  return {pose.x + step.x(), pose.y + step.y(), pose.heading + row.a};
}

Recording recorded(const std::vector<Twist>& rows, const std::vector<std::string>& columns,
                   const Wheels& wheels) {
  Recording recording;
  recording.name = "other drive";
  for (const std::string& name : columns) recording.drive.covariates.push_back({name, {}});
  Pose pose;
  recording.truth.push_back({0.0, 0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double t = 0.1 * static_cast<double>(k + 1);
    recording.drive.t.push_back(t);
    const std::vector<double> shown = wheels(rows[k]);
    for (std::size_t n = 0; n < columns.size(); ++n) {
      recording.drive.covariates[n].values.push_back(shown[n]);
    }
    pose = next(pose, rows[k]);
    if (k % 10 == 9) recording.truth.push_back({t, pose.x, pose.y, wrap_angle(pose.heading)});
  }
  return recording;
}

struct OtherDrive {
  Model model;
  std::vector<Twist> rows;
  Wheels wheels;
};

OtherDrive omni3() {
  OtherDrive drive;
  Robot& robot = drive.model.robot;
  robot.drive = DriveKind::omni3;
  robot.length = 0.2;
  robot.wheelbase = 0.2;
  robot.columns = {"wheel1", "wheel2", "wheel3"};
  drive.rows = driven(true);
  drive.wheels = [](const Twist& row) {
    std::vector<double> shown;
    for (const double place : {-M_PI / 3.0, M_PI / 3.0, M_PI}) {
      const double rolls = place - M_PI / 2.0;
      shown.push_back(row.f * std::cos(rolls) + row.s * std::sin(rolls) - 0.2 * row.a);
    }
    return shown;
  };
  return drive;
}

OtherDrive tricycle() {
  OtherDrive drive;
  Robot& robot = drive.model.robot;
  robot.drive = DriveKind::tricycle;
  robot.length = 0.9;
  robot.wheelbase = 0.9;
  robot.columns = {"wheel", "steer"};
  drive.rows = driven(false);
  drive.wheels = [](const Twist& row) {
    return std::vector<double>{std::hypot(row.f, 0.9 * row.a), std::atan2(0.9 * row.a, row.f)};
  };
  return drive;
}

/// The effect's g makes the columns show less than they would.
Wheels with_effect(const OtherDrive& drive, Channel channel, double g) {
  return [wheels = drive.wheels, channel, g](Twist row) {
    if (channel == Channel::sideways) row.s /= 1.0 + g;
    std::vector<double> shown = wheels(row);
    if (const std::optional<std::size_t> n = wheel_of(channel)) shown[*n] /= 1.0 + g;
    if (channel == Channel::steer) {
      // To first order: d (cos b - g sin b, sin b + g cos b) is what the body does.
      shown[0] /= std::sqrt(1.0 + g * g);
      shown[1] -= std::atan(g);
    }
    return shown;
  };
}

struct Hidden {
  const char* name;
  OtherDrive (*drive)();
  Channel channel;
  double g;
};

class OtherDrives : public ::testing::TestWithParam<Hidden> {};

TEST_P(OtherDrives, ANoiseFreeEffectIsFoundAndLeavesNothing) {
  const Hidden& hidden = GetParam();
  const OtherDrive drive = hidden.drive();
  Model model = drive.model;
  const Recording recording = with_wheels(
      recorded(drive.rows, model.robot.columns, with_effect(drive, hidden.channel, hidden.g)),
      model.robot);
  EXPECT_GT(fit_model({recording}, model).chi2, 100.0);
  model.effects.push_back({"hidden", hidden.channel, {"1"}, {}, false});
  const ModelFit fit = fit_model({recording}, model);
  EXPECT_LT(fit.chi2, 1e-6);
  EXPECT_NEAR(fit.model.effects.front().coefficients.front(), hidden.g, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Effects, OtherDrives,
                         ::testing::Values(Hidden{"Sideways", omni3, Channel::sideways, -0.05},
                                           Hidden{"Wheel1", omni3, Channel::wheel1, 0.02},
                                           Hidden{"Wheel3", omni3, Channel::wheel3, -0.03},
                                           Hidden{"TricycleWheel", tricycle, Channel::wheel1, 0.02},
                                           Hidden{"Steer", tricycle, Channel::steer, 0.03}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(OtherDrives, WithoutEffectNothingIsLeft) {
  for (const auto& make : {omni3, tricycle}) {
    const OtherDrive drive = make();
    const Recording recording = with_wheels(
        recorded(drive.rows, drive.model.robot.columns, drive.wheels), drive.model.robot);
    EXPECT_LT(fit_model({recording}, drive.model).chi2, 1e-6);
  }
}

/// Per segment, what a channel's column says against what slightly other readings of the columns
/// lead to.
TEST(OtherDrives, ColumnsAreThoseOfDifferences) {
  constexpr double kStep = 1e-5;
  for (const auto& make : {omni3, tricycle}) {
    const OtherDrive drive = make();
    const Robot& robot = drive.model.robot;
    const Recording raw = recorded(drive.rows, robot.columns, drive.wheels);
    const Drive here = with_wheels(raw, robot).drive;
    std::vector<Channel> channels;
    for (const ChannelFacts& one : trussmap::channels()) {
      if (wheel_of(one.channel) || one.channel == Channel::steer ||
          one.channel == Channel::steer_gain) {
        if (is_of_drive(one.channel, robot)) channels.push_back(one.channel);
      }
    }
    EXPECT_EQ(channels.size(), 3U);
    for (const Channel channel : channels) {
      const auto end = [&](double g) {
        Recording other = raw;
        const std::size_t k = wheel_of(channel).value_or(1);
        for (double& one : other.drive.covariates[k].values) {
          one = channel == Channel::steer ? one + g : one * (1.0 + g);
        }
        const Drive moved = with_wheels(other, robot).drive;
        const SegmentMotion motion = segment_motion(segment_rows(moved, 5.0, 17.3, robot));
        const Pose& d = motion.displacement;
        return Eigen::Vector3d(d.x, d.y, d.heading);
      };
      const Eigen::Vector3d expected =
          (8.0 * (end(kStep) - end(-kStep)) - end(2.0 * kStep) + end(-2.0 * kStep)) /
          (12.0 * kStep);
      std::vector<DrivePattern> patterns;
      for (std::size_t row = 0; row < here.rows(); ++row) {
        patterns.push_back(drive_pattern(channel, 1.0, shown_travel(here, row), robot.wheelbase));
      }
      const SegmentWithEffects found = segment_motion(segment_rows(here, 5.0, 17.3, robot),
                                                      {&patterns}, Eigen::VectorXd::Zero(1));
      EXPECT_LT((found.derivatives.col(0).head<3>() - expected).norm(), 1e-6 * expected.norm())
          << name_of(channel);
    }
  }
}

/// The columns with the noise that the model states: k per wheel, and of the steering.
Wheels noisy(const OtherDrive& drive, double k, double steer, std::mt19937& random) {
  return [wheels = drive.wheels, k, steer, &random](const Twist& row) {
    std::normal_distribution<double> normal;
    std::vector<double> shown = wheels(row);
    const double way = std::abs(shown[0]);
    for (std::size_t n = 0; n < shown.size(); ++n) {
      const bool steers = shown.size() == 2 && n == 1;
      shown[n] +=
          normal(random) * (steers ? steer / std::sqrt(way) : k * std::sqrt(std::abs(shown[n])));
    }
    return shown;
  };
}

TEST(OtherDrives, DeadReckoningScattersAsItsCovarianceSays) {
  constexpr int kDrives = 400;
  constexpr double kWheel = 0.004;
  constexpr double kSteer = 0.003;
  std::mt19937 random(19);
  for (const auto& make : {omni3, tricycle}) {
    OtherDrive drive = make();
    Noise& noise = drive.model.noise;
    noise.left = noise.right = kWheel;
    noise.steer = kSteer;
    Pose end;
    for (const Twist& row : drive.rows) end = next(end, row);
    double sum = 0.0;
    for (int k = 0; k < kDrives; ++k) {
      const Recording recording = with_wheels(
          recorded(drive.rows, drive.model.robot.columns, noisy(drive, kWheel, kSteer, random)),
          drive.model.robot);
      const PoseEstimate found =
          dead_reckoned_estimates(recording.drive, drive.model.robot, noise).back();
      const Eigen::Vector3d error(found.pose.x - end.x, found.pose.y - end.y,
                                  wrap_angle(found.pose.heading - end.heading));
      sum += error.dot(found.covariance.inverse() * error);
    }
    // Of chi-square(3): mean 3, standard deviation sqrt 6.
    EXPECT_NEAR(sum / kDrives, 3.0, 4.0 * std::sqrt(6.0 / kDrives)) << drive.model.robot.length;
  }
}

TEST(OtherDrives, FitsHaveTheChiSquareOfTheirDegreesOfFreedom) {
  constexpr int kDrives = 40;
  std::mt19937 random(23);
  std::normal_distribution<double> normal;
  for (const auto& make : {omni3, tricycle}) {
    OtherDrive drive = make();
    Noise& noise = drive.model.noise;
    noise.left = noise.right = 0.004;
    noise.steer = 0.003;
    double chi2 = 0.0;
    double dof = 0.0;
    for (int k = 0; k < kDrives; ++k) {
      Recording recording = with_wheels(
          recorded(drive.rows, drive.model.robot.columns, noisy(drive, 0.004, 0.003, random)),
          drive.model.robot);
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
}

TEST(OtherDrives, CalibrationFindsEachDrivesConstants) {
  std::mt19937 random(29);
  for (const auto& make : {omni3, tricycle}) {
    OtherDrive drive = make();
    Model& model = drive.model;
    model.noise.left = model.noise.right = 0.002;
    model.noise.steer = 0.002;
    const bool steers = model.robot.drive == DriveKind::tricycle;
    const Channel channel = steers ? Channel::steer : Channel::wheel2;
    drive.wheels = with_effect(drive, channel, 0.02);
    const Recording recording = with_wheels(
        recorded(drive.rows, model.robot.columns, noisy(drive, 0.002, 0.002, random)), model.robot);
    const WheelCalibration found = calibrate_wheels({recording}, model);
    EXPECT_FALSE(found.diameter_ratio || found.wheelbase_ratio || found.scale);
    ASSERT_EQ(found.constants.size(), steers ? 3U : 4U);
    for (const DriveConstant& one : found.constants) {
      const double expected = one.channel == channel ? 0.02 : 0.0;
      // The steering's offset is one to first order in g: the rest is a scale of g^2/2.
      EXPECT_NEAR(one.g.value, expected, 4.0 * one.g.sd + 2e-4) << name_of(one.channel);
      EXPECT_LT(one.g.sd, 0.01);
    }
  }
}

}  // namespace
}  // namespace trussmap
