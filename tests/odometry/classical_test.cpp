// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the classical models say of a straight path given in one step or in two, as in the paper's
// own example, and that the closed form does not care: it is the limit of ever smaller steps.
#include "odometry/classical.hpp"

#include "json_matrix.hpp"
#include "shared_data.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::classical_test {
using namespace odometry;
namespace {

constexpr double kDistance = 3.0;  // D, m
constexpr double kAlong = 0.02;    // s_D^2, m^2, per step of D
constexpr double kTurn = 0.01;     // s_a^2, rad^2, per step of D

TEST(ClassicalModel, TwoStepsAreNotOneStepOfTwiceTheNoise) {
  const Motion whole = classical_step(ClassicalModel::turn_then_drive,
                                      {2.0 * kDistance, 0.0, 2.0 * kAlong, 2.0 * kTurn});
  const Motion half =
      classical_step(ClassicalModel::turn_then_drive, {kDistance, 0.0, kAlong, kTurn});
  const Motion halves = then(half, half);
  EXPECT_NEAR(whole.covariance(0, 0), halves.covariance(0, 0), 1e-15);
  EXPECT_NEAR(whole.covariance(2, 2), halves.covariance(2, 2), 1e-15);
  EXPECT_NEAR(whole.covariance(1, 1), 4.0 * kDistance * kDistance * 2.0 * kTurn, 1e-12);
  EXPECT_NEAR(halves.covariance(1, 1), 5.0 * kDistance * kDistance * kTurn, 1e-12);
  EXPECT_NEAR(halves.covariance(1, 2), 3.0 * kDistance * kTurn, 1e-12);
}

TEST(ClassicalModel, TheChordsDirectionDoesNotMakeItConsistent) {
  const Motion whole =
      classical_step(ClassicalModel::midpoint, {2.0 * kDistance, 0.0, 2.0 * kAlong, 2.0 * kTurn});
  const Motion half = classical_step(ClassicalModel::midpoint, {kDistance, 0.0, kAlong, kTurn});
  // (D s/2)^2 each, and the first half's turn swings the second by D: 1/4 + 9/4 against 4 * 2/4.
  EXPECT_NEAR(then(half, half).covariance(1, 1), 2.5 * kDistance * kDistance * kTurn, 1e-12);
  EXPECT_NEAR(whole.covariance(1, 1), 2.0 * kDistance * kDistance * kTurn, 1e-12);
}

class ClosedForm : public ::testing::TestWithParam<int> {};

TEST_P(ClosedForm, IsTheSameInSegments) {
  const WheelNoise noise{0.002, 0.003};
  for (const WheelTravel& travel :
       {WheelTravel{2.0, 2.0}, WheelTravel{-1.5, -1.0}, WheelTravel{-0.6, 0.6},
        WheelTravel{1.0, 3.0}, WheelTravel{1.0 + 1e-9, 1.0 - 1e-9}}) {
    const Motion whole = arc_motion(travel, 0.4, noise);
    const int segments = GetParam();
    const Motion segment =
        arc_motion({travel.left / segments, travel.right / segments}, 0.4, noise);
    Motion path;
    for (int k = 0; k < segments; ++k) path = then(path, segment);
    const double scale = whole.covariance.cwiseAbs().maxCoeff();
    EXPECT_LE((path.covariance - whole.covariance).cwiseAbs().maxCoeff(), 1e-13 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Segments, ClosedForm, ::testing::Values(2, 7, 100));

/// The paper's recursion (eq. 15) over `segments` equal arcs, each wheel's noise entering at once
/// at the end of its segment; Jacobians by central differences of the exact displacement.
Matrix3 discrete_covariance(const WheelTravel& travel, double wheelbase, const WheelNoise& noise,
                            int segments) {
  const WheelTravel segment{travel.left / segments, travel.right / segments};
  constexpr double h = 1e-5;  // m
  const auto difference = [&](double left, double right) {
    const Pose ahead = arc_displacement({segment.left + left, segment.right + right}, wheelbase);
    const Pose behind = arc_displacement({segment.left - left, segment.right - right}, wheelbase);
    return Eigen::Vector3d((ahead.x - behind.x) / (2.0 * h), (ahead.y - behind.y) / (2.0 * h),
                           (ahead.heading - behind.heading) / (2.0 * h));
  };
  const Eigen::Vector3d by_left = difference(h, 0.0);
  const Eigen::Vector3d by_right = difference(0.0, h);
  const Matrix3 one =
      noise.left * noise.left * std::abs(segment.left) * by_left * by_left.transpose() +
      noise.right * noise.right * std::abs(segment.right) * by_right * by_right.transpose();
  Motion path;
  for (int k = 0; k < segments; ++k) {
    path = then(path, {arc_displacement(segment, wheelbase), one});
  }
  return path.covariance;
}

TEST(ClosedForm, IsTheLimitOfTheDiscreteRecursion) {
  double previous = 0.0;
  for (const testing::Case& one : testing::cases("chong_kleeman.json", "discrete_recursion")) {
    const nlohmann::json& c = one.content;
    const WheelTravel travel{c["L"], c["R"]};
    const WheelNoise noise{c["kL"], c["kR"]};
    const int segments = c["k"];
    const Matrix3 T = pose_rotation(c["theta0"]);
    const Matrix3 discrete =
        T * discrete_covariance(travel, c["B"], noise, segments) * T.transpose();
    const Matrix3 expected = testing::matrix<3, 3>(c["cov"]);
    EXPECT_LE((discrete - expected).norm(), 1e-8 * expected.norm()) << segments;
    const Matrix3 closed = T * arc_motion(travel, c["B"], noise).covariance * T.transpose();
    const double error = (expected - closed).norm() / closed.norm();
    // The error is a/k^2: the same a from 10 segments as from 100.
    if (segments == 100) {
      EXPECT_NEAR(previous / error, 100.0, 0.1);
    }
    previous = error;
  }
}

}  // namespace
}  // namespace trussmap::classical_test
