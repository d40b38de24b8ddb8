// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/planar.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::planar_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(WrapAngle, LiesInTheHalfOpenCircle) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi / 2.0), -kPi / 2.0, 1e-15);
  EXPECT_NEAR(wrap_angle(1000.0 * kPi + 0.25), 0.25, 1e-12);
  EXPECT_NEAR(wrap_angle(-7.0), -7.0 + 2.0 * kPi, 1e-15);
}

TEST(UnwrapNear, IsTheNearestOfAllTurns) {
  for (const double reference : {-20.0, -3.2, 0.0, 3.1, 50.0}) {
    for (const double angle : {-3.0, -0.1, 2.0, 3.14}) {
      const double near = unwrap_near(angle, reference);
      EXPECT_LE(std::abs(near - reference), kPi + 1e-12);
      EXPECT_NEAR(std::remainder(near - angle, 2.0 * kPi), 0.0, 1e-12);
    }
  }
}

/// A pose is a rotation and a shift of the complex plane: z -> e^(i heading) z + (x + i y).
TEST(Pose, ComposesLikeMapsOfTheComplexPlane) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-5.0, 5.0);
  const auto draw = [&] { return Pose{uniform(random), uniform(random), uniform(random)}; };
  const auto map = [](const Pose& pose, std::complex<double> z) {
    return std::polar(1.0, pose.heading) * z + std::complex<double>(pose.x, pose.y);
  };
  for (int k = 0; k < 100; ++k) {
    const Pose a = draw();
    const Pose b = draw();
    const std::complex<double> z(uniform(random), uniform(random));
    EXPECT_LE(std::abs(map(compose(a, b), z) - map(a, map(b, z))), 1e-13);
    EXPECT_LE(std::abs(map(inverse(a), map(a, z)) - z), 1e-13);
    EXPECT_LE(std::abs(map(a, map(relative(a, b), z)) - map(b, z)), 1e-13);
    EXPECT_EQ(compose(a, b).heading, a.heading + b.heading);  // whole turns are kept
  }
}

TEST(QuarterTurn, IsCounterClockwise) {
  const Vector2 v(3.0, 4.0);
  EXPECT_EQ(quarter_turn(v), Vector2(-4.0, 3.0));
  EXPECT_LE((rotation(kPi / 2.0) * v - quarter_turn(v)).norm(), 1e-15);
  EXPECT_NEAR(direction(quarter_turn(v)) - direction(v), kPi / 2.0, 1e-15);
}

}  // namespace
}  // namespace trussmap::planar_test
