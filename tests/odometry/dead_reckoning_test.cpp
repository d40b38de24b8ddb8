// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Dead reckoning over recorded rows: cutting, merging, the compass, landmarks at both ends.
#include "trussmap/dead_reckoning.hpp"

#include "driven.hpp"
#include "geometry/index.hpp"
#include "odometry/merge.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::dead_reckoning_test {
using namespace odometry;
namespace {

/// Spin, straight, arc, reverse: 20 rows of 0.1 s each, wheel noise added if asked (seed 5).
MotionRows varied_drive(double noise_k) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  MotionRows drive;
  const WheelTravel kinds[] = {{-0.02, 0.02}, {0.1, 0.1}, {0.08, 0.12}, {-0.05, -0.06}};
  for (const WheelTravel& kind : kinds) {
    for (int k = 0; k < 20; ++k) {
      drive.t.push_back(0.1 * static_cast<double>(drive.t.size() + 1));
      const double left = kind.left + noise_k * std::sqrt(std::abs(kind.left)) * normal(random);
      const double right = kind.right + noise_k * std::sqrt(std::abs(kind.right)) * normal(random);
      testing::add_travels(drive, left, right);
    }
  }
  return drive;
}

const Robot kRobot{0.34};

PoseEstimate reckon(const MotionRows& drive, double from, double to,
                    const PoseEstimate& start = {}) {
  return dead_reckon(start, drive, from, to, kRobot, Noise{});
}

TEST(DeadReckoning, AnyCutComposesToTheWhole) {
  const MotionRows drive = varied_drive(0.0);
  const PoseEstimate whole = reckon(drive, 0.0, 8.0);
  for (const double cut : {0.05, 1.0, 2.34, 3.999, 7.95}) {
    const PoseEstimate parts = reckon(drive, cut, 8.0, reckon(drive, 0.0, cut));
    EXPECT_NEAR(parts.pose.x, whole.pose.x, 1e-12) << cut;
    EXPECT_NEAR(parts.pose.y, whole.pose.y, 1e-12) << cut;
    EXPECT_NEAR(parts.pose.heading, whole.pose.heading, 1e-12) << cut;
    EXPECT_LE((parts.covariance - whole.covariance).norm(), 1e-12 * whole.covariance.norm());
  }
}

TEST(DeadReckoning, EachKindOfMotionIsOneArc) {
  const MotionRows drive = varied_drive(0.0);
  const auto arcs = merge_rows(drive, rows_between(drive, 0.0, 8.0), kRobot, {0.003, 0.003});
  ASSERT_EQ(arcs.size(), 4U);
  EXPECT_NEAR(arcs[2].motion.forward, 2.0, 1e-12);
  EXPECT_NEAR(arcs[2].motion.turn, 0.8 / 0.34, 1e-12);
  EXPECT_NEAR(arcs[3].duration, 2.0, 1e-12);
}

/// Merging replaces the rows' noisy path by an arc: the covariance changes by the noise's share.
TEST(DeadReckoning, MergedCovarianceIsThatOfTheRows) {
  const MotionRows drive = varied_drive(0.003);
  Motion rows;
  for (const DriveRow& row : rows_between(drive, 0.0, 8.0)) {
    rows = then(rows, arc_motion(row.part * drive.pair.at(row.row), 0.34, {0.003, 0.003}));
  }
  const PoseEstimate merged = reckon(drive, 0.0, 8.0);
  EXPECT_NEAR(merged.pose.x, rows.displacement.x, 1e-12);
  EXPECT_LE((merged.covariance - rows.covariance).norm(), 0.02 * rows.covariance.norm());
}

/// With a compass: 400 simulated drives (seed 6). The squared distance of the estimate from the
/// truth by its own covariance has mean 3 and variance 6 per drive; 4 standard errors of the mean
/// of 400 are 4 sqrt(6/400) = 0.49.
TEST(DeadReckoning, TheCompassFilterIsAsSureAsItShouldBe) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  const MotionRows truth = varied_drive(0.0);
  const Noise noise;
  double sum = 0.0;
  for (int run = 0; run < 400; ++run) {
    MotionRows drive = truth;
    Pose pose;
    PoseEstimate start;
    start.covariance(2, 2) = 0.1 * 0.1;
    start.pose.heading = 0.1 * normal(random);
    for (std::size_t row = 0; row < truth.rows(); ++row) {
      pose = compose(pose, arc_displacement(truth.pair.at(row), 0.34));
      drive.pair.left[row] +=
          noise.left * std::sqrt(std::abs(truth.pair.left[row])) * normal(random);
      drive.pair.right[row] +=
          noise.right * std::sqrt(std::abs(truth.pair.right[row])) * normal(random);
      drive.heading.push_back(row % 5 == 2 ? kAbsent
                                           : pose.heading + noise.compass * normal(random));
    }
    testing::retake(drive);
    const PoseEstimate end = dead_reckon(start, drive, 0.0, 8.0, kRobot, noise);
    const Eigen::Vector3d error(end.pose.x - pose.x, end.pose.y - pose.y,
                                wrap_angle(end.pose.heading - pose.heading));
    sum += error.dot(end.covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / 400.0, 3.0, 0.49);
}

TEST(DeadReckoning, RangeAndBearingMeetInEveryQuadrant) {
  for (const double bearing : {0.4, 2.0, -2.5, -0.7}) {
    for (const double heading : {0.0, 1.0, -3.0}) {
      const Sighting sighting{0.0, "A", 2.5, bearing};
      const LandmarkOffset offset = landmark_offset(sighting, Noise{});
      const PoseEstimate robot = pose_from_landmark({heading, 0.01}, offset);
      const PositionEstimate back = landmark_from_pose(robot, offset);
      EXPECT_LE(back.position.norm(), 1e-12);
      EXPECT_NEAR(direction(-robot.pose.position()), wrap_angle(heading + bearing), 1e-12);
      // Seen again from where it was seen, its heading error cancels; the sighting counts twice.
      EXPECT_NEAR(back.covariance.trace(), 2.0 * offset.covariance_robot.trace(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace trussmap::dead_reckoning_test
