// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rounds of squares, each driven with the corrections of those before.
#include "calibration/square_simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::square_rounds_test {
namespace {

using testing::simulated_runs;

constexpr double kSide = 4.0;
constexpr double kWheelbase = 0.34;

/// A robot that is reprogrammed after every round.
std::vector<SquareRound> driven_rounds(std::size_t count, double tape_sd, SquareMethod method,
                                       std::uint64_t seed) {
  TapeRobot robot = misbuilt_robot(kWheelbase, 1.01, 1.04);
  robot.tape_sd = tape_sd;
  std::mt19937_64 random(seed);
  return square_rounds(
      count, kSide, kWheelbase, {}, method,
      [&](std::size_t /*round*/, const SquareSetup& setup, const GeometryErrors& in_force) {
        return simulated_runs(
            reprogrammed(robot, in_force.left_factor(), in_force.right_factor(), setup.wheelbase),
            setup.side, 5, random);
      });
}

TEST(SquareRounds, CorrectionsMultiplyToTheRobotAsItIs) {
  // Without noise the exact solution needs one round, the formulas leave a little for a second.
  for (const auto& [method, rounds] :
       {std::pair(SquareMethod::exact, 1U), std::pair(SquareMethod::formulas, 6U)}) {
    const std::vector<SquareRound> all = driven_rounds(rounds, 0.0, method, 1);
    ASSERT_EQ(all.size(), rounds);
    const SquareCorrections found = corrections_after(all.back(), method);
    EXPECT_NEAR(found.errors.diameter_ratio, 1.01, 1e-6);
    EXPECT_NEAR(found.errors.wheelbase_ratio, 1.04, 1e-6);
    EXPECT_NEAR(found.wheelbase.value, 1.04 * kWheelbase, 1e-6);
    EXPECT_NEAR(found.left_factor.value + found.right_factor.value, 2.0, 1e-12);
  }
}

TEST(SquareRounds, ARoundIsDrivenWithWhatTheOnesBeforeFound) {
  const std::vector<SquareRound> all = driven_rounds(3, 0.005, SquareMethod::exact, 2);
  EXPECT_EQ(all[0].in_force.diameter_ratio, 1.0);
  for (std::size_t k = 1; k < all.size(); ++k) {
    const SquareCorrections before = corrections_after(all[k - 1], SquareMethod::exact);
    EXPECT_EQ(all[k].in_force.diameter_ratio, before.errors.diameter_ratio);
    EXPECT_NEAR(all[k].setup.wheelbase, before.wheelbase.value, 1e-15);
  }
}

TEST(SquareRounds, StandardErrorsOfTheProductAreItsSlope) {
  const std::vector<SquareRound> all = driven_rounds(2, 0.01, SquareMethod::exact, 3);
  const SquareCorrections found = corrections_after(all.back(), SquareMethod::exact);
  ASSERT_GT(found.left_factor.standard_error, 0.0);
  SquareRound moved = all.back();
  const double h = 1e-6;
  moved.exact.diameter_ratio.value += h;
  const SquareCorrections next = corrections_after(moved, SquareMethod::exact);
  const double se = all.back().exact.diameter_ratio.standard_error;
  EXPECT_NEAR(found.left_factor.standard_error,
              std::abs(next.left_factor.value - found.left_factor.value) / h * se, 1e-6 * se);
  EXPECT_NEAR(found.right_factor.standard_error,
              std::abs(next.right_factor.value - found.right_factor.value) / h * se, 1e-6 * se);
}

TEST(SquareRounds, DoubtsNameTheirRound) {
  const std::vector<SquareRound> one = driven_rounds(1, 0.0, SquareMethod::exact, 1);
  ASSERT_FALSE(all_doubts(one).empty());  // runs all equal
  EXPECT_EQ(all_doubts(one).front().rfind("all runs", 0), 0U);
  const std::vector<std::string> two = all_doubts(driven_rounds(2, 0.0, SquareMethod::exact, 1));
  for (const std::string begin : {"round 1: all runs", "round 2: all runs"}) {
    EXPECT_TRUE(std::any_of(two.begin(), two.end(), [&](const std::string& doubt) {
      return doubt.starts_with(begin);
    })) << begin;
  }
}

}  // namespace
}  // namespace trussmap::square_rounds_test
