// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/square_simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::square_checks_test {
namespace {

using testing::simulated_clusters;
using testing::simulated_runs;

const SquareSetup kSquare{4.0, 0.34};

std::string doubts(const SquareRuns& runs, const SquareSetup& setup = kSquare) {
  std::string all;
  for (const std::string& doubt : square_doubts(square_clusters(runs), setup)) all += doubt + "\n";
  return all;
}

SquareRuns some_runs(double e_d, double e_b, std::uint64_t seed) {
  TapeRobot robot = misbuilt_robot(kSquare.wheelbase, e_d, e_b);
  robot.tape_sd = 0.01;
  std::mt19937_64 random(seed);
  return simulated_runs(robot, kSquare.side, 5, random);
}

TEST(SquareDoubts, NoneAboutProperRuns) {
  // A doubt needs p < 0.001: of 300 good calibrations 0.3 are expected to raise one.
  int doubted = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    doubted +=
        doubts(some_runs(1.0 + 1e-5 * static_cast<double>(seed), 0.99, seed)).empty() ? 0 : 1;
  }
  EXPECT_LE(doubted, 3);
}

TEST(SquareDoubts, ExchangedLabelsAreNamedWhateverTheErrors) {
  for (const auto& [e_d, e_b] : {std::pair(1.00084, 0.98874), std::pair(1.0, 1.02),
                                 std::pair(0.997, 1.0), std::pair(0.999, 0.985)}) {
    SquareRuns runs = some_runs(e_d, e_b, 5);
    EXPECT_EQ(doubts(runs), "");
    std::swap(runs.cw, runs.ccw);
    EXPECT_NE(doubts(runs).find("exchanged"), std::string::npos) << e_d << " " << e_b;
  }
}

TEST(SquareDoubts, AWrongSignOfYIsNamed) {
  SquareRuns runs = some_runs(1.001, 0.98, 6);
  for (auto* sample : {&runs.cw, &runs.ccw}) {
    for (Eigen::Vector2d& e : *sample) e.y() = -e.y();
  }
  EXPECT_NE(doubts(runs).find("y had the other sign"), std::string::npos);
}

TEST(SquareDoubts, UnitsEqualRunsAndUnexplainedErrorsAreNamed) {
  const SquareRuns runs = some_runs(1.0005, 0.99, 7);
  EXPECT_NE(doubts(runs, {4000.0, 0.34}).find("--side is in metres"), std::string::npos);
  EXPECT_NE(doubts(runs, {4.0, 340.0}).find("wheelbase"), std::string::npos);
  SquareRuns equal = runs;
  equal.cw.assign(5, runs.cw[0]);
  equal.ccw.assign(5, runs.ccw[0]);
  EXPECT_NE(doubts(equal).find("equal"), std::string::npos);
  SquareRuns turned = runs;  // a start heading off by a few degrees turns neither alpha nor beta
  for (Eigen::Vector2d& e : turned.cw) e += Eigen::Vector2d(0.3, -0.3);
  for (Eigen::Vector2d& e : turned.ccw) e += Eigen::Vector2d(-0.2, -0.4);
  EXPECT_FALSE(doubts(turned).empty());
}

/// Of a robot that a computer drove without noise.
TEST(SquareDoubts, WhatRoundingLeavesIsNoContradictionAndNoOutlier) {
  SquareRuns runs;
  runs.cw = {{1e-15, 0.0}, {0.0, 2e-15}, {0.0, 0.0}, {0.0, 0.0}, {3e-14, 0.0}};
  runs.ccw = {{0.0, 0.0}, {-1e-15, 0.0}, {0.0, 1e-15}, {0.0, 0.0}, {0.0, -2e-14}};
  EXPECT_EQ(doubts(runs), "");
  EXPECT_TRUE(square_outliers(runs).empty());
}

TEST(OneWayTuning, OneDirectionHidesWhatTheOtherShows) {
  // Borenstein & Feng, Fig. 4: the two errors cancel one way and add up the other.
  const GeometryErrors errors{1.00084, 0.98874};
  for (const Direction driven : {Direction::cw, Direction::ccw}) {
    const OneWayTuning tuned = tune_one_way(errors, kSquare, driven);
    EXPECT_LT(tuned.error_same_way, 0.1 * tuned.error_before);
    // What is left the other way is all of twice the type B error: 4 sqrt(2) L |beta|.
    const double beta = 0.00084 * kSquare.side / kSquare.wheelbase;
    EXPECT_NEAR(tuned.error_other_way, 4.0 * std::sqrt(2.0) * kSquare.side * beta, 0.02);
    EXPECT_GT(tuned.error_other_way, 20.0 * tuned.error_same_way);
  }
  // The tuned robot, simulated, does what is said of it.
  const OneWayTuning tuned = tune_one_way(errors, kSquare, Direction::ccw);
  const TapeRobot robot =
      reprogrammed(misbuilt_robot(kSquare.wheelbase, errors.diameter_ratio, errors.wheelbase_ratio),
                   1.0, 1.0, kSquare.wheelbase * tuned.wheelbase_ratio);
  const SquareClusters ends = simulated_clusters(robot, kSquare.side);
  EXPECT_NEAR(ends.ccw.mean.norm(), tuned.error_same_way, 1e-6);
  EXPECT_NEAR(ends.cw.mean.norm(), tuned.error_other_way, 1e-6);
}

/// 0.3 % of 1000 sets of ordinary runs, seed 21, give a false alarm: 3 +- 1.7.
TEST(SquareOutliers, ARunFarFromTheOthersIsNamedAndOrdinaryScatterIsNot) {
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  int alarms = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    SquareRuns runs;
    for (int k = 0; k < 5; ++k) {
      runs.cw.emplace_back(0.1 + 0.02 * normal(random), 0.02 * normal(random));
      runs.ccw.emplace_back(-0.1 + 0.02 * normal(random), 0.02 * normal(random));
    }
    alarms += square_outliers(runs).empty() ? 0 : 1;
    runs.cw[2].x() += 1.0;
    const std::vector<std::string> found = square_outliers(runs);
    const bool named = std::any_of(found.begin(), found.end(), [](const std::string& one) {
      return one.starts_with("run 3 of direction cw ends");
    });
    EXPECT_TRUE(named) << trial;
  }
  EXPECT_LE(alarms, 10);
}

}  // namespace
}  // namespace trussmap::square_checks_test
