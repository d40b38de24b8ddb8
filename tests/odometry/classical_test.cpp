// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the classical models say of a straight path given in one step or in two, as in the paper's
// own example, and that the closed form does not care.
#include "trussmap/odometry/classical.hpp"

#include <gtest/gtest.h>

namespace trussmap {
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

TEST_P(ClosedForm, IsTheSameInPieces) {
  const WheelNoise noise{0.002, 0.003};
  for (const WheelTravel& travel :
       {WheelTravel{2.0, 2.0}, WheelTravel{-1.5, -1.0}, WheelTravel{-0.6, 0.6},
        WheelTravel{1.0, 3.0}, WheelTravel{1.0 + 1e-9, 1.0 - 1e-9}}) {
    const Motion whole = arc_motion(travel, 0.4, noise);
    const int pieces = GetParam();
    const Motion piece = arc_motion({travel.left / pieces, travel.right / pieces}, 0.4, noise);
    Motion path;
    for (int k = 0; k < pieces; ++k) path = then(path, piece);
    const double scale = whole.covariance.cwiseAbs().maxCoeff();
    EXPECT_LE((path.covariance - whole.covariance).cwiseAbs().maxCoeff(), 1e-13 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Pieces, ClosedForm, ::testing::Values(2, 7, 100));

}  // namespace
}  // namespace trussmap
