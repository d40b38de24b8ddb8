// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stated uncertainties against what thousands of simulated calibrations do.
#include "calibration/square_simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::coverage_test {
namespace {

using testing::simulated_runs;

constexpr int kTrials = 2000;
constexpr int kRuns = 5;

struct Coverage {
  int diameter_ratio = 0;
  int wheelbase_ratio = 0;
  double worst_share() const { return std::min(diameter_ratio, wheelbase_ratio) / double{kTrials}; }
  double best_share() const { return std::max(diameter_ratio, wheelbase_ratio) / double{kTrials}; }
};

bool holds(const Interval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

Coverage coverage(const TapeRobot& robot, double e_d, double e_b, std::uint64_t seed) {
  const SquareSetup setup{4.0, robot.wheelbase_believed};
  std::mt19937_64 random(seed);
  Coverage result;
  for (int trial = 0; trial < kTrials; ++trial) {
    const SquareSolution found =
        solve_square(square_clusters(simulated_runs(robot, setup.side, kRuns, random)), setup);
    result.diameter_ratio += holds(confidence_interval(found.diameter_ratio), e_d) ? 1 : 0;
    result.wheelbase_ratio += holds(confidence_interval(found.wheelbase_ratio), e_b) ? 1 : 0;
  }
  return result;
}

// 95 % of 2000 has a standard error of 0.5 %: 93 and 97 % are four of them away.

TEST(SolveSquareCoverage, TapeScatterOf25Millimetres) {
  TapeRobot robot = misbuilt_robot(0.34, 1.002, 0.99);
  robot.tape_sd = 0.025;
  const Coverage found = coverage(robot, 1.002, 0.99, 1);
  EXPECT_GE(found.worst_share(), 0.93);
  EXPECT_LE(found.best_share(), 0.97);
}

TEST(SolveSquareCoverage, NoisyWheels) {
  TapeRobot robot = misbuilt_robot(0.5, 0.998, 1.01);
  robot.left_noise = 0.0008;
  robot.right_noise = 0.0012;
  robot.tape_sd = 0.002;
  robot.step = 0.4;
  const Coverage found = coverage(robot, 0.998, 1.01, 2);
  EXPECT_GE(found.worst_share(), 0.93);
  EXPECT_LE(found.best_share(), 0.97);
}

TEST(UmbmarkStandardErrors, AgreeWithTheScatterOfManyCalibrations) {
  TapeRobot robot = misbuilt_robot(0.34, 1.00084, 0.98874);
  robot.tape_sd = 0.025;
  const SquareSetup setup{4.0, 0.34};
  std::mt19937_64 random(4);
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  Eigen::Array4d stated = Eigen::Array4d::Zero();
  const auto value = [](const SquareSolution& s) {
    return Eigen::Array4d(s.alpha.value, s.beta.value, s.diameter_ratio.value, s.wheelbase.value);
  };
  const auto variance = [](const SquareSolution& s) -> Eigen::Array4d {
    return Eigen::Array4d(s.alpha.standard_error, s.beta.standard_error,
                          s.diameter_ratio.standard_error, s.wheelbase.standard_error)
        .square();
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    const SquareSolution found =
        umbmark(square_clusters(simulated_runs(robot, setup.side, kRuns, random)), setup);
    sum += value(found);
    squares += value(found).square();
    stated += variance(found);
  }
  const Eigen::Array4d scatter = squares / kTrials - (sum / kTrials).square();
  // A variance from 2000 draws is sure to sqrt(2/2000) = 3.2 %, the mean of 2000 stated ones (8
  // degrees of freedom each) to 1.1 %.
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(stated[k] / kTrials / scatter[k], 1.0, 0.14) << k;
}

}  // namespace
}  // namespace trussmap::coverage_test
