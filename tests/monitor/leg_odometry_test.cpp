// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A leg for the monitor: its covariance beside then(), its effects beside differences.
#include "monitor/leg_odometry.hpp"

#include "effects/simple_shapes.hpp"
#include "fit/online_odometry.hpp"
#include "monitor/lasting_error.hpp"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::leg_odometry_test {
using namespace monitor;
namespace {

/// Turns and arcs, of 40 rows (seed 4), with a gyro that disagrees.
std::vector<WheelRow> some_rows(bool gyro) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> travel(-0.05, 0.2);
  std::vector<WheelRow> rows;
  for (int k = 0; k < 40; ++k) {
    WheelRow row{0.2, travel(random), travel(random)};
    if (gyro) row.yaw_rate = (row.right - row.left) / 0.34 / 0.2 + 0.1 * travel(random);
    rows.push_back(row);
  }
  return rows;
}

const std::vector<Channel> kChannels{Channel::travel, Channel::left,       Channel::right,
                                     Channel::wheels, Channel::difference, Channel::turn,
                                     Channel::drift,  Channel::creep};

LegReckoning driven(const Model& model, bool gyro, std::vector<Channel> channels) {
  OdometryInputs inputs;
  inputs.gyro = gyro;
  fitting::OnlineOdometry odometry(model, inputs);
  LegOdometry leg(std::move(channels));
  for (const WheelRow& row : some_rows(gyro)) {
    const CorrectedRow one = odometry.drive(row, {});
    leg.take(one.motion, odometry.shown(), odometry.reading(), odometry.excess(), 1e-6);
  }
  return leg.finish();
}

TEST(LegOdometry, CovarianceIsThatOfRowsPutTogether) {
  const Model model;
  CorrectedOdometry odometry(model);
  Motion motion;
  for (const WheelRow& row : some_rows(false)) motion = then(motion, odometry.drive(row).motion);
  const LegReckoning leg = driven(model, false, {});
  EXPECT_NEAR((leg.covariance.topLeftCorner<3, 3>() - motion.covariance).norm(), 0.0,
              1e-12 * motion.covariance.norm());
  EXPECT_NEAR((leg.displacement.position() - motion.displacement.position()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(leg.displacement.heading, motion.displacement.heading, 1e-12);
  EXPECT_NEAR(leg.duration, 8.0, 1e-12);
}

/// What a model with this effect makes of the same rows, beside what the leg says of its channel.
void expect_differences(bool gyro, const std::vector<Channel>& channels) {
  const Model model;
  const LegReckoning leg = driven(model, gyro, channels);
  constexpr double kSmall = 1e-5;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::array<LegReckoning, 2> ends;
    for (const int side : {0, 1}) {
      Model other = model;
      other.effects.push_back(
          {"one", channels[k], {effects::constant_shape()}, {side == 0 ? -kSmall : kSmall}});
      ends[static_cast<std::size_t>(side)] = driven(other, gyro, {});
    }
    const auto column = leg.by_channel.col(static_cast<Eigen::Index>(k));
    const Vector2 moved =
        (ends[1].displacement.position() - ends[0].displacement.position()) / (2.0 * kSmall);
    EXPECT_NEAR((column.head<2>() - moved).norm(), 0.0, 2e-3 * (moved.norm() + 1e-2))
        << name_of(channels[k]);
    EXPECT_NEAR(column[2],
                (ends[1].displacement.heading - ends[0].displacement.heading) / (2.0 * kSmall),
                1e-6)
        << name_of(channels[k]);
    EXPECT_NEAR(column[kLegExcess], (ends[1].excess - ends[0].excess) / (2.0 * kSmall), 1e-6)
        << name_of(channels[k]);
  }
}

TEST(LegOdometry, EffectsAreDerivativesOfTheLeg) {
  expect_differences(false, kChannels);
}

TEST(LegOdometry, EffectsAreDerivativesBesideAGyroToo) {
  std::vector<Channel> channels = kChannels;
  channels.push_back(Channel::gyro);
  channels.push_back(Channel::gyro_scale);
  expect_differences(true, channels);
}

TEST(LegOdometry, ReadingsAreAveragedAtTheStart) {
  LegOdometry leg({Channel::drift});
  drive::RowMotion row = drive::row_motion(BodyMotion{0.1, 0.0, 0.0}, 1.0, Robot());
  double turned = 0.0;
  for (int k = 0; k < 10; ++k) {  // readings wrap; the start reads 3.0
    row.body.turn = 0.1;
    turned += 0.1;
    leg.take({{0.1, 0.0, 0.1}, Matrix3::Identity() * 1e-6}, row,
             wrap_angle(3.0 + turned + (k % 2 == 0 ? 0.3 : -0.1)), 0.0, 0.0);
  }
  const LegReckoning done = leg.finish();
  EXPECT_EQ(done.readings, 10);
  EXPECT_NEAR(wrap_angle(done.heading - 3.1), 0.0, 1e-12);
  // A drift of 1 rad/s adds k rad to the k-th reading: 5.5 on average.
  EXPECT_NEAR(done.by_channel(kLegMeanHeading, 0), 5.5, 1e-12);
  EXPECT_NEAR(done.by_channel(2, 0), 10.0, 1e-12);
  // Cov of the sum of ten steps with the mean of their partial sums: the same 5.5.
  EXPECT_NEAR(done.covariance(2, kLegMeanHeading), 5.5e-6, 1e-15);
}

// Means of an Ornstein-Uhlenbeck process over two neighbouring legs, by sums over its covariance.
TEST(LastingError, HasTheMomentsOfMeansOverLegs) {
  constexpr double kLength = 2.0;
  constexpr int kSteps = 400;
  const std::array<double, 2> lasts{3.0, 7.0};
  const auto covariance = [&](double from_a, double a, double from_b, double b) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double lag = from_a + a * (i + 0.5) / kSteps - from_b - b * (j + 0.5) / kSteps;
        sum += std::exp(-std::abs(lag) / kLength);
      }
    }
    return 0.04 * sum / (kSteps * kSteps);
  };
  LastingError error({Channel::compass, ProcessKind::correlated_in_t, 0.2, kLength});
  LegReckoning leg;
  leg.duration = lasts[0];
  const LastingError::Step first = error.next(leg);
  leg.duration = lasts[1];
  const LastingError::Step second = error.next(leg);
  const double var_first = covariance(0.0, lasts[0], 0.0, lasts[0]);
  EXPECT_NEAR(first.variance, var_first, 1e-4 * var_first);
  const double both = covariance(0.0, lasts[0], lasts[0], lasts[1]);
  EXPECT_NEAR(second.rho * first.variance, both, 1e-4 * both);
  const double var_second = covariance(0.0, lasts[1], 0.0, lasts[1]);
  EXPECT_NEAR(second.rho * second.rho * first.variance + second.variance, var_second,
              1e-4 * var_second);
}

}  // namespace
}  // namespace trussmap::leg_odometry_test
