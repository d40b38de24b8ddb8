// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Exact moments of a noisy path's end: against the first order where noise is small, against
// simulation where it is not.
#include "calibration/end_moments.hpp"

#include "trussmap/simulation.hpp"
#include "trussmap/wheel_noise.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::end_moments_test {
using namespace calibration;
namespace {

const TestPath kPaths[] = {{{10.0, 0.0}, {-10.0, 0.0}},
                           {{3.0, 0.0}, {0.0, 1.5}, {2.0, -0.8}},
                           {{-2.0, 0.5}, {0.0, -4.0}, {1.0, 2.0}}};

/// The second order is smaller by k^2.
TEST(EndMoments, AreOfFirstOrderForLittleNoise) {
  for (const double k2 : {1e-18, 1e-12, 1e-8}) {
    const Vector2 squared(4.0 * k2, k2);
    for (const TestPath& path : kPaths) {
      const NoiseShape shape = noise_shape(path, 0.34);
      const Matrix3 first = squared[0] * shape.left + squared[1] * shape.right;
      const EndMoments exact = end_moments(path, 0.34, squared);
      EXPECT_LE((exact.covariance - first).norm(), (1e-8 + 1e4 * k2) * first.norm()) << k2;
      EXPECT_LE(exact.mean.norm(), 1e4 * k2) << k2;
    }
  }
}

/// 40000 simulated ends (seed 8) with k five times the usual: means are sure to sd/200, variances
/// to 1 to 2 % (bends have heavy tails), covariances accordingly.
TEST(EndMoments, AreThoseOfManySimulatedDrives) {
  constexpr int kRuns = 40000;
  for (const TestPath& path : kPaths) {
    TapeRobot robot = misbuilt_robot(0.34, 1.0, 1.0);
    robot.left_noise = 0.003;
    robot.right_noise = 0.005;
    robot.step = 0.1;
    std::mt19937_64 random(8);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Matrix3 squares = Matrix3::Zero();
    for (const Pose& end : drive_often(robot, path, kRuns, random)) {
      const Eigen::Vector3d e(end.x, end.y, end.heading);
      sum += e;
      squares += e * e.transpose();
    }
    const Eigen::Vector3d mean = sum / kRuns;
    const Matrix3 covariance = squares / kRuns - mean * mean.transpose();
    const EndMoments exact = end_moments(path, 0.34, Vector2(9e-6, 25e-6));
    for (int i = 0; i < 3; ++i) {
      const double sd = std::sqrt(exact.covariance(i, i));
      EXPECT_NEAR(mean[i], exact.mean[i], 4.0 * sd / 200.0) << i;
      for (int j = 0; j <= i; ++j) {
        const double scale = sd * std::sqrt(exact.covariance(j, j));
        EXPECT_NEAR(covariance(i, j), exact.covariance(i, j), 0.05 * scale) << i << j;
      }
    }
  }
}

TEST(EndMoments, TheBendIsLargeOnALongPathWithUsualWheels) {
  const EndMoments exact = end_moments(kPaths[0], 0.34, Vector2(9e-6, 25e-6));
  const NoiseShape shape = noise_shape(kPaths[0], 0.34);
  const Matrix3 first = 9e-6 * shape.left + 25e-6 * shape.right;
  EXPECT_GT(exact.covariance(0, 0), 2.0 * first(0, 0));
}

}  // namespace
}  // namespace trussmap::end_moments_test
