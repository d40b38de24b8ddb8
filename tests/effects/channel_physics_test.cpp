// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns of the channels against differences of what the table of channels says, written out here
// once more.
#include "effects/channel_physics.hpp"

#include "effects/channel_record.hpp"
#include "effects/corrected_recording.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::channel_physics_test {
using namespace effects;
using namespace drive;
namespace {

constexpr double kWheelbase = 0.4;
const Robot kRobot{.wheelbase = kWheelbase};

/// What the robot did in a row, given what its wheels say: ds, slip, dtheta, reading less heading.
Eigen::Vector4d motion(Channel channel, double g, const RowMotion& row) {
  double left = row.body.forward - 0.5 * kWheelbase * row.body.turn;
  double right = row.body.forward + 0.5 * kWheelbase * row.body.turn;
  if (channel == Channel::left || channel == Channel::wheels) left *= 1.0 + g;
  if (channel == Channel::right || channel == Channel::wheels) right *= 1.0 + g;
  if (channel == Channel::difference) {
    left *= 1.0 - g / 2.0;
    right *= 1.0 + g / 2.0;
  }
  double ds = (left + right) / 2.0;
  double dtheta = (right - left) / kWheelbase;
  const double slip = channel == Channel::creep ? g * ds : 0.0;
  if (channel == Channel::travel) ds *= 1.0 + g;
  if (channel == Channel::advance) ds += g;
  if (channel == Channel::turn) dtheta *= 1.0 + g;
  if (channel == Channel::drift) dtheta += g * row.duration;
  if (channel == Channel::rotate) dtheta += g;
  return {ds, slip, dtheta, channel == Channel::compass ? g : 0.0};
}

/// A reading of a landmark 3 m ahead and 2 m to the left of the axle: range, bearing.
Eigen::Vector2d reading(Channel channel, double g, double speed, double turn_rate) {
  // A late stamp is believed to be from where the robot was g later.
  const double late = channel == Channel::delay ? g : 0.0;
  const Vector2 moved(speed * late, 0.0);
  const double turned = turn_rate * late;
  const Vector2 sensor(channel == Channel::lever ? g : 0.0,
                       channel == Channel::lever_left ? g : 0.0);
  // Where it stands at the stamp, the landmark is seen from where it stood before.
  const Vector2 view = Vector2(3.0, 2.0) + moved - sensor;
  double range = view.norm();
  double bearing = direction(view) + turned;
  if (channel == Channel::range) range += g;
  if (channel == Channel::range_scale) range *= 1.0 + g;
  if (channel == Channel::bearing) bearing += g;
  return {range, bearing};
}

/// The same by a pattern's definition: the sensor `ahead` and `left` of the axle, looking `heading`
/// further left.
Eigen::Vector2d reading(const ViewPattern& pattern) {
  const Vector2 view = Vector2(3.0, 2.0) - Vector2(pattern.ahead, pattern.left);
  return {view.norm() * (1.0 + pattern.range_scale) + pattern.range,
          direction(view) - pattern.heading + pattern.bearing};
}

RowMotion any_row(std::mt19937_64& random) {
  std::uniform_real_distribution<double> travel(-0.2, 0.3);
  return row_motion(body_motion({travel(random), travel(random)}, kWheelbase), 0.1, kRobot);
}

bool of_gyro(Channel channel) {
  return channel == Channel::gyro || channel == Channel::gyro_scale;
}

class EveryChannel : public ::testing::TestWithParam<Channel> {};

TEST_P(EveryChannel, AddsToARowWhatTheTableSays) {
  std::mt19937_64 random(2);
  bool acts = false;
  for (int k = 0; k < 50; ++k) {
    const RowMotion row = any_row(random);
    const double step = 1e-3;
    const Eigen::Vector4d expected =
        (motion(GetParam(), step, row) - motion(GetParam(), -step, row)) / (2.0 * step);
    const DrivePattern found = drive_pattern(GetParam(), 1.0, row);
    EXPECT_LT(
        (Eigen::Vector4d(found.advance, found.slip, found.turn, found.compass) - expected).norm(),
        1e-12);
    acts = acts || expected.norm() > 0.0;
    // Linear in g: the column is the physics.
    const DrivePattern twice = drive_pattern(GetParam(), -2.0, row);
    EXPECT_DOUBLE_EQ(twice.advance, -2.0 * found.advance);
    EXPECT_DOUBLE_EQ(twice.turn, -2.0 * found.turn);
  }
  EXPECT_EQ(acts, acts_on(GetParam()) != ActsOn::views && !of_gyro(GetParam()) &&
                      is_of_drive(GetParam(), Robot()));
}

/// Where a gyro is believed by a share, a row moves by that share of what the gyro says, and by the
/// rest of what the wheels say.
TEST_P(EveryChannel, AddsToARowWithAGyroWhatBothSay) {
  const Channel channel = GetParam();
  std::mt19937_64 random(3);
  for (int k = 0; k < 20; ++k) {
    RowMotion row = any_row(random);
    row.gyro_reads = true;
    row.gyro_turn = 0.21;
    row.gyro_along = 0.004;
    row.gyro_share = 0.8;
    const double step = 1e-3;
    const auto said = [&](double g) {
      const Eigen::Vector4d wheels = motion(channel, g, row);
      double turn = row.gyro_turn;
      if (channel == Channel::gyro) turn -= g * row.duration;
      if (channel == Channel::gyro_scale) turn *= 1.0 + g;
      const double excess = turn - wheels[2];
      Eigen::Matrix<double, 5, 1> all;
      all << wheels + excess * Eigen::Vector4d(0.004, 0.0, 0.8, 0.0), excess;
      return all;
    };
    const Eigen::Matrix<double, 5, 1> expected = (said(step) - said(-step)) / (2.0 * step);
    const DrivePattern found = drive_pattern(channel, 1.0, row);
    Eigen::Matrix<double, 5, 1> all;
    all << found.advance, found.slip, found.turn, found.compass, found.excess;
    EXPECT_LT((all - expected).norm(), 1e-12);
  }
}

TEST(ChannelPhysics, FixesHaveAnAntennaAndAClockOfTheirOwn) {
  const ViewVector all = view_pattern(Channel::antenna, 0.2, 0.6, -0.3).vector() +
                         view_pattern(Channel::antenna_left, -0.1, 0.6, -0.3).vector() +
                         view_pattern(Channel::fix_delay, 0.5, 0.6, -0.3).vector() +
                         view_pattern(Channel::fix_x, 3.0, 0.6, -0.3).vector() +
                         view_pattern(Channel::fix_y, 4.0, 0.6, -0.3).vector();
  const ViewVector expected =
      (ViewVector() << 0.2 - 0.3, -0.1, 0.15, 0.0, 0.0, 0.0, 3.0, 4.0, 0.0).finished();
  EXPECT_LT((all - expected).norm(), 1e-15);
  for (const ChannelFacts& one : channels()) {
    if (!acts_on_fixes(one.channel)) continue;
    EXPECT_FALSE(acts_on_sightings(one.channel)) << one.name;
    EXPECT_FALSE(acts_on_truth(one.channel)) << one.name;
    EXPECT_FALSE(is_recordable(one.channel)) << one.name;
  }
}

TEST(ChannelPhysics, LoopsHaveAScannerOfTheirOwn) {
  const ViewVector all = view_pattern(Channel::scanner, 0.2, 0.6, -0.3).vector() +
                         view_pattern(Channel::scanner_left, -0.1, 0.6, -0.3).vector() +
                         view_pattern(Channel::scanner_yaw, 0.5, 0.6, -0.3).vector();
  const ViewVector expected =
      (ViewVector() << 0.2, -0.1, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished();
  EXPECT_LT((all - expected).norm(), 1e-15);
  for (const ChannelFacts& one : channels()) {
    if (!acts_on_loops(one.channel)) continue;
    EXPECT_FALSE(acts_on_sightings(one.channel)) << one.name;
    EXPECT_FALSE(acts_on_truth(one.channel)) << one.name;
    EXPECT_FALSE(acts_on_fixes(one.channel)) << one.name;
    EXPECT_FALSE(is_recordable(one.channel)) << one.name;
  }
}

TEST(ChannelPhysics, ATruthsHeadingIsNothingThatSightingsKnow) {
  EXPECT_FALSE(acts_on_sightings(Channel::truth_heading));
  EXPECT_EQ(acts_on(Channel::truth_heading), ActsOn::views);
  const ViewPattern found = view_pattern(Channel::truth_heading, 0.2, 0.6, -0.3);
  EXPECT_EQ(found.vector(),
            (ViewVector() << 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished());
}

TEST(ChannelPhysics, AYawIsNothingThatRangesAndTruthKnow) {
  EXPECT_TRUE(acts_on_sightings(Channel::sighting_yaw));
  EXPECT_FALSE(acts_on_truth(Channel::sighting_yaw));
  const ViewPattern found = view_pattern(Channel::sighting_yaw, 0.2, 0.6, -0.3);
  EXPECT_EQ(found.vector(),
            (ViewVector() << 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2).finished());
  Sighting tag{1.0, "A"};
  tag.yaw = wrap_angle(3.2);
  EXPECT_NEAR(without(Channel::sighting_yaw, 0.2, tag).yaw, 3.0, 1e-15);
}

TEST_P(EveryChannel, AddsToAViewWhatTheTableSays) {
  if (GetParam() == Channel::sighting_yaw) return;                                // above
  if (GetParam() == Channel::truth_heading || acts_on_fixes(GetParam())) return;  // above
  if (acts_on_loops(GetParam())) return;                                          // above
  const double speed = 0.6;
  const double turn_rate = -0.3;
  const double step = 1e-4;
  const auto slope = [step](const Eigen::Vector2d& more, const Eigen::Vector2d& less) {
    return Eigen::Vector2d((more - less) / (2.0 * step));
  };
  const Eigen::Vector2d expected = slope(reading(GetParam(), step, speed, turn_rate),
                                         reading(GetParam(), -step, speed, turn_rate));
  const Eigen::Vector2d found = slope(reading(view_pattern(GetParam(), step, speed, turn_rate)),
                                      reading(view_pattern(GetParam(), -step, speed, turn_rate)));
  EXPECT_LT((found - expected).norm(), 1e-6);
  EXPECT_EQ(expected.norm() > 0.0, acts_on(GetParam()) == ActsOn::views);
}

TEST_P(EveryChannel, LeavesTheRobotsMotionWhereARecordingIsFreedFromIt) {
  if (!is_recordable(GetParam()) || acts_on(GetParam()) != ActsOn::drives) return;
  std::mt19937_64 random(3);
  for (int k = 0; k < 50; ++k) {
    const RowMotion row = any_row(random);
    MotionRows drive;
    drive.t = {0.1, 0.2};
    drive.forward = {row.body.forward, row.body.forward};
    drive.turn = {row.body.turn, row.body.turn};
    free_drive(GetParam(), {0.07, 0.07}, kRobot, drive);
    const Eigen::Vector4d did = motion(GetParam(), 0.07, row);
    EXPECT_NEAR(drive.forward[1], did[0], 1e-15);
    EXPECT_NEAR(drive.turn[1], did[2], 1e-14);
  }
}

std::vector<Channel> all_channels() {
  std::vector<Channel> all;
  for (const ChannelFacts& one : channels()) all.push_back(one.channel);
  return all;
}

INSTANTIATE_TEST_SUITE_P(ChannelPhysics, EveryChannel, ::testing::ValuesIn(all_channels()),
                         [](const auto& which) { return std::string(name_of(which.param)); });

TEST(ChannelPhysics, ASightingIsFreedFromWhatWasAddedToIt) {
  const Sighting truth{1.0, "A", 2.5, 3.0};
  const auto freed = [&](Channel channel, double range, double bearing) {
    return without(channel, 0.2, Sighting{1.0, "A", range, bearing});
  };
  EXPECT_NEAR(freed(Channel::range, 2.7, 3.0).range, truth.range, 1e-15);
  EXPECT_NEAR(freed(Channel::range_scale, 3.0, 3.0).range, truth.range, 1e-15);
  EXPECT_NEAR(freed(Channel::bearing, 2.5, wrap_angle(3.2)).bearing, truth.bearing, 1e-15);
  EXPECT_EQ(freed(Channel::range, 2.7, 3.0).bearing, truth.bearing);
}

/// An effect of one wheel is believed to be as large as one of both, or of all travel.
TEST(Channels, ProportionsHaveOnePrior) {
  using enum Channel;
  for (const Channel channel : {travel, left, right, wheels, difference, turn, gyro_scale, sideways,
                                wheel1, wheel6, steer_gain}) {
    EXPECT_EQ(facts_of(channel).prior_sd, 0.1) << name_of(channel);
  }
}

/// A row that lacks something would show as an empty word, or as an effect that does nothing.
TEST(Channels, HaveACompleteRowEachInTheirOrder) {
  for (std::size_t k = 0; k < channel_records().size(); ++k) {
    const ChannelRecord& one = channel_records()[k];
    EXPECT_EQ(static_cast<std::size_t>(one.facts.channel), k) << one.facts.name;
    EXPECT_FALSE(one.facts.does_what.empty() || one.noun.empty() || one.axis.empty() ||
                 one.phrase.subject.empty() || one.phrase.more.empty() || one.phrase.less.empty())
        << one.facts.name;
    const bool views = one.target.kind == ActsOn::views;
    EXPECT_EQ(views, one.view_pattern != nullptr) << one.facts.name;
    EXPECT_EQ(views,
              one.target.sightings || one.target.truth || one.target.fixes || one.target.loops)
        << one.facts.name;
    EXPECT_NE(one.view_pattern != nullptr,
              one.wheel_pattern != nullptr || one.gyro_pattern != nullptr)
        << one.facts.name;
    EXPECT_EQ(one.gyro_pattern == nullptr, one.yaw_rate_without == nullptr) << one.facts.name;
  }
}

TEST(Channels, OfSingleWheelsAreCalledByTheirNumber) {
  const ChannelRecord& third = record_of(Channel::wheel3);
  EXPECT_EQ(third.facts.name, "wheel3");
  EXPECT_EQ(third.facts.does_what, "travel of the third wheel");
  EXPECT_EQ(third.phrase.subject, "the third wheel rolls");
  EXPECT_EQ(third.noun, "third wheel's error");
  EXPECT_EQ(third.axis, "third wheel rolls further than it says by");
  EXPECT_EQ(record_of(Channel::wheel6).noun, "sixth wheel's error");
}

TEST(Channels, HaveOneNameEach) {
  EXPECT_EQ(channels().size(), 41U);
  for (const ChannelFacts& one : channels()) {
    EXPECT_EQ(parse_channel(one.name), one.channel);
    EXPECT_EQ(channel_named(one.name), one.channel);
    EXPECT_EQ(name_of(one.channel), one.name);
    EXPECT_GT(one.prior_sd, 0.0);
  }
  EXPECT_EQ(parse_channel("Turn"), std::nullopt);
  try {
    (void)channel_named("spin");
    ADD_FAILURE() << "an unknown channel was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(
        std::string(error.what()).rfind("channel \"spin\" is unknown, expected one of travel,", 0),
        0U);
  }
}

}  // namespace
}  // namespace trussmap::channel_physics_test
