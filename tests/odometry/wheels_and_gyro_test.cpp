// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/wheels_and_gyro.hpp"

#include "drive/body_motion.hpp"
#include "driven.hpp"
#include "odometry/row_reckoner.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::wheels_and_gyro_test {
using namespace odometry;
namespace {

Noise noise_of(double left, double right, double gyro) {
  Noise noise;
  noise.left = left;
  noise.right = right;
  noise.gyro = gyro;
  return noise;
}

/// Of a row's path and turn by generalised least squares: the wheels measure both, the gyro the
/// turn.
TEST(WheelsAndGyro, AreTakenTogetherAsLeastSquaresHasIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Robot robot{0.4};
  for (int k = 0; k < 50; ++k) {
    const Noise noise =
        noise_of(0.004 + 0.003 * unit(random), 0.004, 0.002 + 0.0015 * unit(random));
    const WheelTravel wheels{0.1 * unit(random), 0.1 * unit(random)};
    const double duration = 0.3;
    const double rate = unit(random);
    const GyroShare share = gyro_share(drive::body_motion(wheels, 0.4), rate, duration, noise,
                                       arc_noise(wheels, duration, robot, noise));

    // d(path, turn)/d(left, right), and the two wheels' own variances.
    Matrix2 T;
    T << 0.5, 0.5, -1.0 / 0.4, 1.0 / 0.4;
    const Matrix2 of_wheels = Vector2(noise.left * noise.left * std::abs(wheels.left),
                                      noise.right * noise.right * std::abs(wheels.right))
                                  .asDiagonal();
    Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
    C.topLeftCorner<2, 2>() = T * of_wheels * T.transpose();
    C(2, 2) = noise.gyro * noise.gyro * duration;
    Eigen::Matrix<double, 3, 2> A;
    A << 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
    Eigen::Vector3d y;
    y << T * Vector2(wheels.left, wheels.right), rate * duration;
    const Matrix2 expected_covariance = (A.transpose() * C.inverse() * A).inverse();
    const Vector2 expected = expected_covariance * A.transpose() * C.inverse() * y;

    const BodyMotion both = together(share);
    EXPECT_LT((Vector2(both.forward, both.turn) - expected).norm(), 1e-12);
    const ArcNoise left =
        noise_together(share, arc_noise(wheels, duration, robot, noise), duration, noise);
    const double size = expected_covariance.norm();
    EXPECT_NEAR(left.along, expected_covariance(0, 0), 1e-12 * size);
    EXPECT_NEAR(left.heading, expected_covariance(1, 1), 1e-12 * size);
    EXPECT_NEAR(left.shared, expected_covariance(0, 1), 1e-12 * size);
  }
}

MotionRows a_drive() {
  MotionRows drive;
  drive.t = {0.1, 0.2, 0.3};
  testing::add_travels(drive, 0.05, 0.06, 0.3);
  testing::add_travels(drive, 0.0, 0.0, 0.3);
  testing::add_travels(drive, -0.02, 0.03, 0.3);
  drive.yaw_rate = {0.2, 0.01, kAbsent};
  return drive;
}

TEST(WheelsAndGyro, ARobotWhoseWheelsStandStillStandsWhateverTheGyroSays) {
  const MotionRows drive = with_gyro(a_drive(), Robot{0.3}, noise_of(0.003, 0.003, 0.001));
  EXPECT_EQ(drive.forward[1], 0.0);
  EXPECT_EQ(drive.turn[1], 0.0);
  EXPECT_TRUE(drive.rests(1));
  EXPECT_NEAR(drive.gyro[1].excess, 0.001, 1e-15);
  EXPECT_NEAR(excess_variance(drive, 1, 1.0, 0.1, Robot{0.3}, noise_of(0.003, 0.003, 0.001)),
              1e-6 * 0.1, 1e-18);
}

TEST(WheelsAndGyro, ARowWithoutAReadingIsTheWheelsAlone) {
  const Noise noise = noise_of(0.003, 0.003, 0.001);
  const Robot robot{0.3};
  const MotionRows drive = with_gyro(a_drive(), robot, noise);
  EXPECT_EQ(drive.forward[2], a_drive().forward[2]);
  EXPECT_EQ(drive.turn[2], a_drive().turn[2]);
  EXPECT_TRUE(std::isinf(excess_variance(drive, 2, 1.0, 0.1, robot, noise)));
  const Matrix3 alone = arc_covariance({-0.02, 0.03}, 0.1, robot, noise);
  EXPECT_LT((row_covariance(drive, 2, 1.0, 0.1, robot, noise) - alone).norm(),
            1e-14 * alone.norm());
}

/// Straight ahead the mean of a wheel and one that counts backwards is nothing.
TEST(WheelsAndGyro, AWheelIsAsNoisyWhicheverWayItCounts) {
  const Robot robot{0.3};
  const Noise noise = noise_of(0.003, 0.003, 0.001);
  MotionRows drive[2];
  for (const int k : {0, 1}) {
    drive[k].t = {0.1};
    testing::add_travels(drive[k], k == 0 ? 0.05 : -0.05, 0.05, 0.3);
    drive[k].yaw_rate = {0.0};
    drive[k] = with_gyro(drive[k], robot, noise);
  }
  const double way = 0.5 * noise.left * noise.left * 0.05;  // of a mean of two wheels
  EXPECT_NEAR(row_noise(drive[0], 0, 1.0, 0.1, robot, noise).along, way, 1e-9 * way);
  EXPECT_NEAR(row_noise(drive[1], 0, 1.0, 0.1, robot, noise).along, way, 1e-9 * way);
}

TEST(WheelsAndGyro, AreTakenTogetherOnce) {
  const Noise noise = noise_of(0.003, 0.003, 0.001);
  const MotionRows once = with_gyro(a_drive(), Robot{0.3}, noise);
  const MotionRows twice = with_gyro(once, Robot{0.3}, noise);
  EXPECT_EQ(once.turn, twice.turn);
  EXPECT_EQ(once.wheel_motion(0).turn, a_drive().turn[0]);
  EXPECT_NE(once.turn[0], a_drive().turn[0]);
  EXPECT_EQ(once.pair.left, a_drive().pair.left);
  MotionRows without = a_drive();
  without.yaw_rate.clear();
  EXPECT_EQ(with_gyro(without, Robot{0.3}, noise).turn, without.turn);
  EXPECT_TRUE(with_gyro(without, Robot{0.3}, noise).gyro.empty());
}

}  // namespace
}  // namespace trussmap::wheels_and_gyro_test
