// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model's odometry row by row on drives with other wheels than two, against the same reckoned
// afterwards.
#include "effects/channel_physics.hpp"
#include "effects/steering.hpp"
#include "fit/online_models.hpp"
#include "other_drives.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/corrected_odometry.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::corrected_odometry_drives_test {
using namespace effects;
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::own_effect;

constexpr DriveKind kDrives[] = {DriveKind::unicycle,  DriveKind::skid_steer, DriveKind::tricycle,
                                 DriveKind::ackermann, DriveKind::omni3,      DriveKind::mecanum,
                                 DriveKind::wheels};

struct Sensors {
  bool compass = false;
  bool gyro = false;
};

/// A noisy drive (seed 5) as with_wheels makes it, with readings that are missing now and then.
DrivenRecording driven_with(const OtherDrive& drive, const Sensors& sensors) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  DrivenRecording recording = with_wheels(
      testing::recorded(drive, testing::noisy(drive, drive.wheels, random)), drive.model.robot);
  double heading = 2.5;  // rad, so that readings wrap
  for (std::size_t row = 0; row < drive.rows.size(); ++row) {
    heading += drive.rows[row].a;
    const double rate = drive.rows[row].a / testing::kOtherRow;
    const double reads = wrap_angle(heading + 0.02 * normal(random));
    const double turns = rate + 0.003 * normal(random);
    if (sensors.compass) recording.drive.heading.push_back(row % 3 == 0 ? reads : kAbsent);
    if (sensors.gyro) recording.drive.yaw_rate.push_back(row % 7 == 0 ? kAbsent : turns);
  }
  return recording;
}

OdometryInputs inputs_of(const MotionRows& drive) {
  OdometryInputs inputs;
  inputs.compass = drive.has_compass();
  inputs.gyro = drive.has_gyro();
  for (const Covariate& one : drive.covariates) inputs.covariates.push_back(one.name);
  return inputs;
}

CorrectedRow drive_row(CorrectedOdometry& odometry, const MotionRows& drive, std::size_t row) {
  WheelRow now{drive.duration(row)};
  if (drive.has_compass()) now.compass = drive.heading[row];
  if (drive.has_gyro()) now.yaw_rate = drive.yaw_rate[row];
  const std::size_t columns = std::max(drive.wheels.size(), drive.unicycle.size());
  for (std::size_t k = 0; k < columns; ++k) {
    now.readings.push_back(drive.covariates[k].values[row]);
  }
  std::vector<double> covariates;
  for (const Covariate& one : drive.covariates) covariates.push_back(one.values[row]);
  return odometry.drive(now, covariates);
}

void expect_the_same(const DrivenRecording& recording, const Model& model,
                     const std::string& what) {
  CorrectedOdometry odometry(model, inputs_of(recording.drive));
  const std::vector<TimedPose> after = dead_reckoned_poses(recording, model);
  double place = 0.0;
  double heading = 0.0;
  double covariance = 0.0;
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    const PoseEstimate here = drive_row(odometry, recording.drive, row).pose;
    const PoseEstimate& there = after[row + 1].estimate;
    place = std::max(place, (here.pose.position() - there.pose.position()).norm());
    heading = std::max(heading, std::abs(here.pose.heading - there.pose.heading));
    covariance = std::max(covariance, (here.covariance - there.covariance).norm() /
                                          (there.covariance.norm() + 1e-12));
  }
  // Beside a gyro shapes see the way as it was read up to what steering does to the gyro's weights
  // (drive/as_read.hpp).
  const bool both = recording.drive.has_gyro() && steers(model.effects);
  EXPECT_LT(place, both ? 1e-6 : 1e-9) << what;
  EXPECT_LT(heading, both ? 1e-7 : 1e-11) << what;
  EXPECT_LT(covariance, both ? 1e-6 : 1e-9) << what;
}

/// One of each channel that acts on this drive, and on its sensors.
std::vector<Effect> effects_on(const Robot& robot) {
  std::vector<Effect> effects;
  for (const ChannelFacts& one : channels()) {
    const ActsOn acts = acts_on(one.channel);
    if (acts == ActsOn::views || !is_of_drive(one.channel, robot)) continue;
    effects.push_back(own_effect(one.channel, "1", one.channel == Channel::drift ? 0.002 : 0.01));
  }
  effects.push_back(own_effect(Channel::turn, "distance", 0.001));
  effects.push_back(own_effect(Channel::wheels, robot.columns.front().c_str(), 0.2));
  effects.push_back(catalogue_effect("loss per start", {0.02}));
  return effects;
}

class CorrectedOdometryOfDrives : public ::testing::TestWithParam<DriveKind> {};

TEST_P(CorrectedOdometryOfDrives, IsDeadReckoningByTheModelRowByRow) {
  const OtherDrive drive = other_drive(GetParam());
  const std::vector<Effect> effects = effects_on(drive.model.robot);
  EXPECT_GT(effects.size(), 10U);
  for (const Sensors& sensors : {Sensors{}, {true, false}, {false, true}, {true, true}}) {
    const DrivenRecording recording = driven_with(drive, sensors);
    Model model = drive.model;
    model.noise.steer = 0.02;
    expect_the_same(recording, model, "no effect");
    for (const Effect& one : effects) {
      model.effects = {one};
      expect_the_same(recording, model, std::string(name_of(one.channel)));
    }
    model.effects = effects;
    expect_the_same(recording, model, "all together");
    model.noise.left = 0.005;
    model.noise.heading_per_s = 0.001;
    model.noise.heading_per_rad = 0.002;
    model.noise.travel_per_s = 0.001;
    expect_the_same(recording, model, "further noise");
  }
}

/// What is wrong with the drive's constants is taken off: the path is that of the truth.
TEST_P(CorrectedOdometryOfDrives, EffectsThatAreKnownLeaveTheTruePath) {
  const OtherDrive drive = other_drive(GetParam());
  Pose end;
  for (const testing::Twist& row : drive.rows) end = testing::after(end, row);
  for (const Channel channel : drive.constants) {
    const double g = channel == Channel::steer ? 0.2 : -0.02;
    const DrivenRecording recording = with_wheels(
        testing::recorded(drive, testing::with_effect(drive, channel, g)), drive.model.robot);
    Model model = drive.model;
    model.effects = {own_effect(channel, "1", g)};
    CorrectedOdometry odometry(model, inputs_of(recording.drive));
    Pose pose;
    for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
      pose = compose(pose, drive_row(odometry, recording.drive, row).motion.displacement);
    }
    EXPECT_LT((pose.position() - end.position()).norm(), 1e-6) << name_of(channel);
    EXPECT_LT((odometry.pose().pose.position() - end.position()).norm(), 1e-6) << name_of(channel);
  }
}

TEST_P(CorrectedOdometryOfDrives, ARowThatIsRefusedChangesNothing) {
  const OtherDrive drive = other_drive(GetParam());
  const std::vector<double> good = drive.wheels({0.03, 0.0, 0.01});
  const auto row = [](const std::vector<double>& readings) {
    WheelRow one{0.1};
    one.readings = readings;
    return one;
  };
  CorrectedOdometry odometry(drive.model);
  CorrectedOdometry other(drive.model);
  odometry.drive(row(good));
  other.drive(row(good));
  const auto refuses = [&odometry](const WheelRow& one) {
    EXPECT_THROW(odometry.drive(one), std::invalid_argument);
  };
  refuses(WheelRow{0.1});
  refuses(WheelRow{0.1, 0.03, 0.03});
  std::vector<double> readings = good;
  readings.push_back(0.03);
  refuses(row(readings));
  for (std::size_t k = 0; k < good.size(); ++k) {
    for (const double wrong : {kAbsent, HUGE_VAL, 2e6}) {
      readings = good;
      readings[k] = wrong;
      refuses(row(readings));
    }
  }
  WheelRow both = row(good);
  both.left = 0.03;
  refuses(both);
  if (GetParam() == DriveKind::ackermann) {
    for (const double angle : {1.6, -2.0, 1.3}) refuses(row({0.03, angle}));  // 1.3: left of it
  }
  const CorrectedRow here = odometry.drive(row(drive.wheels({0.02, 0.0, -0.01})));
  const CorrectedRow there = other.drive(row(drive.wheels({0.02, 0.0, -0.01})));
  EXPECT_EQ(here.pose.pose.x, there.pose.pose.x);
  EXPECT_EQ(here.pose.pose.heading, there.pose.pose.heading);
  EXPECT_EQ(here.pose.covariance, there.pose.covariance);
}

INSTANTIATE_TEST_SUITE_P(Drives, CorrectedOdometryOfDrives, ::testing::ValuesIn(kDrives),
                         [](const auto& one) {
                           std::string name(name_of(one.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST(CorrectedOdometryOfDrives, RobotsWithoutTheirColumnsOrLengthsAreRefused) {
  for (const DriveKind kind : kDrives) {
    Model model = other_drive(kind).model;
    EXPECT_NO_THROW(CorrectedOdometry{model});
    model.robot.columns.pop_back();
    if (kind == DriveKind::unicycle) model.robot.columns.clear();  // one would do
    EXPECT_THROW(CorrectedOdometry{model}, std::invalid_argument);
    model = other_drive(kind).model;
    model.robot.wheelbase = 0.0;
    EXPECT_THROW(CorrectedOdometry{model}, std::invalid_argument);
    if (kind == DriveKind::unicycle || kind == DriveKind::skid_steer || kind == DriveKind::wheels) {
      continue;
    }
    model = other_drive(kind).model;
    model.robot.length = 0.0;
    EXPECT_THROW(CorrectedOdometry{model}, std::invalid_argument);
  }
  CorrectedOdometry two{Model{}};
  WheelRow row{0.1, 0.03, 0.03};
  row.readings = {0.03, 0.03};
  EXPECT_THROW(two.drive(row), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::corrected_odometry_drives_test
