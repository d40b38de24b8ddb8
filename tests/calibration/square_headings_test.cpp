// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Return orientation errors of squares, and the scale of a straight run, on a robot whose faults
// are known.
#include "calibration/square_simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::square_headings_test {
namespace {

constexpr SquareSetup kSquare{4.0, 0.34};

TapeRobot robot_of(const GeometryErrors& errors) {
  TapeRobot robot =
      misbuilt_robot(kSquare.wheelbase, errors.diameter_ratio, errors.wheelbase_ratio);
  robot.left_share *= errors.scale;
  robot.right_share *= errors.scale;
  return robot;
}

SquareRuns with_headings(const TapeRobot& robot, int runs, std::mt19937_64& random) {
  SquareRuns result;
  for (const Direction way : {Direction::cw, Direction::ccw}) {
    for (const Pose& end : drive_often(robot, square_path(kSquare.side, way), runs, random)) {
      (way == Direction::cw ? result.cw : result.ccw).push_back(end.position());
      (way == Direction::cw ? result.cw_headings : result.ccw_headings).push_back(end.heading);
    }
  }
  return result;
}

SquareRuns with_headings(const GeometryErrors& errors) {
  std::mt19937_64 unused;
  return with_headings(robot_of(errors), 2, unused);
}

SquareSetup scaled(double scale) {
  SquareSetup setup = kSquare;
  setup.scale.value = scale;
  return setup;
}

TEST(SquareHeadings, FindTheFaultsOfTheRobotExactly) {
  for (const GeometryErrors& truth :
       {GeometryErrors{1.002, 0.99}, GeometryErrors{0.985, 1.04}, GeometryErrors{1.01, 0.97, 1.02},
        GeometryErrors{1.0, 1.0, 0.98}, GeometryErrors{1.0001, 1.0001}}) {
    const SquareSetup setup = scaled(truth.scale);
    const SquareRound round = analyse_round(with_headings(truth), setup);
    ASSERT_TRUE(round.headings);
    EXPECT_NEAR(round.headings->diameter_ratio.value, truth.diameter_ratio, 1e-12);
    EXPECT_NEAR(round.headings->wheelbase_ratio.value, truth.wheelbase_ratio, 1e-12);
    EXPECT_NEAR(round.exact.diameter_ratio.value, truth.diameter_ratio, 1e-10);
    EXPECT_NEAR(round.exact.wheelbase_ratio.value, truth.wheelbase_ratio, 1e-10);
    EXPECT_NEAR(round.headings->alpha.value, round.exact.alpha.value, 1e-10);
    EXPECT_NEAR(round.headings->beta.value, round.exact.beta.value, 1e-10);
    EXPECT_NEAR(round.headings->largest,
                4.0 * (std::abs(round.exact.alpha.value) + std::abs(round.exact.beta.value)), 1e-9);
  }
}

TEST(SquareHeadings, AreNoneWhereNoneWereMeasured) {
  SquareRuns runs = with_headings({1.002, 0.99});
  runs.cw_headings.pop_back();
  EXPECT_THROW((void)analyse_round(runs, kSquare), std::invalid_argument);
  runs.cw_headings.clear();
  runs.ccw_headings.clear();
  EXPECT_FALSE(analyse_round(runs, kSquare).headings);
}

TEST(SquareHeadings, ContradictPositionsByChanceAsOftenAsStated) {
  // Wheels' noise moves positions and headings together, measuring them apart.
  TapeRobot robot = robot_of({1.002, 0.99});
  robot.left_noise = robot.right_noise = 0.001;
  robot.tape_sd = 0.01;
  robot.tape_heading_sd = 0.005;
  std::mt19937_64 random(5);
  constexpr int kTrials = 600;
  int alpha_held = 0;
  int beta_held = 0;
  int doubted = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const SquareRuns runs = with_headings(robot, 5, random);
    const SquareSolution exact = solve_square(square_clusters(runs), kSquare);
    const SquareHeadings found = *square_headings(runs, kSquare, exact);
    const auto holds_0 = [](const Estimate& one) {
      const Interval at = confidence_interval(one);
      return at.low <= 0.0 && 0.0 <= at.high;
    };
    alpha_held += holds_0(found.alpha_excess) ? 1 : 0;
    beta_held += holds_0(found.beta_excess) ? 1 : 0;
    doubted += heading_doubts(found).empty() ? 0 : 1;
  }
  // 95 %, three standard errors of 600 trials; doubts come at p < 0.01.
  EXPECT_NEAR(alpha_held / double{kTrials}, 0.95, 0.027);
  EXPECT_NEAR(beta_held / double{kTrials}, 0.95, 0.027);
  EXPECT_LT(doubted, 15);
}

TEST(SquareHeadings, DoubtsAreRaisedWhereHeadingsAreNotAsExpected) {
  TapeRobot robot = robot_of({1.002, 0.98});
  robot.tape_sd = 0.003;
  robot.tape_heading_sd = 0.001;
  std::mt19937_64 random(6);
  const SquareRuns good = with_headings(robot, 5, random);
  const auto doubts = [](SquareRuns runs, double factor, double turn) {
    for (double& one : runs.cw_headings) one = factor * one - turn;
    for (double& one : runs.ccw_headings) one = factor * one + turn;
    const SquareRound round = analyse_round(runs, kSquare);
    return heading_doubts(*round.headings).size();
  };
  const double alpha = analyse_round(good, kSquare).exact.alpha.value;
  EXPECT_EQ(doubts(good, 1.0, 0.0), 0U);
  EXPECT_EQ(doubts(good, -1.0, 0.0), 1U);                          // clockwise
  EXPECT_EQ(doubts(good, 1.0, alpha), 1U);                         // without the fourth turn
  EXPECT_EQ(doubts(good, 180.0 / std::numbers::pi, 0.0), 1U);      // degrees
  EXPECT_EQ(doubts(with_headings({1.002, 0.98}), -1.0, 0.0), 1U);  // no scatter
  EXPECT_EQ(doubts(with_headings({1.002, 0.98}), 1.0, 0.0), 0U);
}

TEST(WheelScale, IsActualOverReportedTravelThoughTheRunIsNotStraight) {
  const GeometryErrors truth{1.01, 0.97, 1.03};
  std::mt19937_64 unused;
  std::vector<StraightRun> runs;
  for (const double length : {10.0, 6.0}) {
    const Pose end = drive_once(robot_of(truth), {{length, 0.0}}, unused);
    runs.push_back({std::hypot(length + end.x, end.y), length});
  }
  EXPECT_LT(wheel_scale(runs).value, truth.scale - 1e-4);  // the chord is shorter than the arc
  const double turn_per_metre =
      (truth.right_factor() - truth.left_factor()) / (kSquare.wheelbase * truth.wheelbase_ratio);
  EXPECT_NEAR(wheel_scale(runs, turn_per_metre).value, truth.scale, 1e-12);
  EXPECT_EQ(wheel_scale({{10.03, 10.0}}).value, 10.03 / 10.0);
  EXPECT_EQ(wheel_scale({{10.03, 10.0}}).dof, 0.0);
  EXPECT_THROW((void)wheel_scale({}), std::invalid_argument);
  EXPECT_THROW((void)wheel_scale({{0.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW((void)wheel_scale({{1.0, 1.0}}, 6.3), std::invalid_argument);
}

TEST(WheelScale, StandardErrorIsThatOfTheTape) {
  // Three runs: mean of se^2 is the variance; four standard errors of 2000 trials, sqrt(2/2000).
  std::mt19937_64 random(7);
  std::normal_distribution<double> tape(0.0, 0.01);
  double variance = 0.0;
  double stated = 0.0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<StraightRun> runs;
    for (const double length : {10.0, 9.0, 8.0}) {
      runs.push_back({1.01 * length + tape(random), length});
    }
    const Estimate found = wheel_scale(runs);
    EXPECT_EQ(found.dof, 2.0);
    variance += std::pow(found.value - 1.01, 2) / kTrials;
    stated += std::pow(found.standard_error, 2) / kTrials;
  }
  EXPECT_NEAR(variance, 1e-4 / (100.0 + 81.0 + 64.0), 0.13 * variance);
  EXPECT_NEAR(stated, variance, 0.2 * variance);
}

/// Squares, and three straight runs before them, by a robot that scatters.
std::vector<SquareRound> rounds_of(const TapeRobot& robot, std::size_t count, bool tape_straight,
                                   SquareMethod method, std::mt19937_64& random) {
  std::vector<StraightRun> straight;
  for (const Pose& end : drive_often(robot, {{10.0, 0.0}}, tape_straight ? 3 : 0, random)) {
    straight.push_back({std::hypot(10.0 + end.x, end.y), 10.0});
  }
  return square_rounds(
      count, kSquare.side, kSquare.wheelbase, {}, method,
      [&](std::size_t /*round*/, const SquareSetup& setup, const GeometryErrors& in_force) {
        return with_headings(
            reprogrammed(robot, in_force.left_factor(), in_force.right_factor(), setup.wheelbase),
            5, random);
      },
      straight);
}

TEST(SquareRoundsWithScale, FindTheRobotAsItIsAndLeaveNothing) {
  const GeometryErrors truth{1.004, 0.98, 1.03};
  std::mt19937_64 unused;
  for (const SquareMethod method : {SquareMethod::exact, SquareMethod::formulas}) {
    const auto rounds = rounds_of(robot_of(truth), 5, true, method, unused);
    // The straight run is bent by what is found without its scale: right to second order.
    const GeometryErrors found = corrections_after(rounds.back(), method).errors;
    EXPECT_NEAR(found.scale, truth.scale, 1e-7);
    EXPECT_NEAR(found.wheelbase_ratio, truth.wheelbase_ratio, 1e-6);
    EXPECT_NEAR(found.diameter_ratio, truth.diameter_ratio, 1e-6);
    EXPECT_EQ(rounds[1].setup.scale.value, 1.0);
    EXPECT_LT(rounds.back().clusters.largest_offset.value, 1e-5);
    EXPECT_NEAR(corrections_after(rounds[0], method).wheelbase.value,
                kSquare.wheelbase * truth.wheelbase_ratio,
                method == SquareMethod::exact ? 1e-6 : 2e-3);
  }
  // Squares alone take the larger wheels for a smaller wheelbase.
  const auto alone = rounds_of(robot_of(truth), 1, false, SquareMethod::exact, unused);
  EXPECT_NEAR(alone[0].exact.wheelbase_ratio.value, truth.wheelbase_ratio / truth.scale, 2e-3);
}

TEST(SquareRoundsWithScale, StandardErrorsHoldWhatTheTapeAddsToThem) {
  const GeometryErrors truth{1.002, 0.99, 1.01};
  TapeRobot robot = robot_of(truth);
  robot.tape_sd = 0.01;
  std::mt19937_64 random(8);
  constexpr int kTrials = 200;
  int wheelbase_held = 0;
  int factor_held = 0;
  const auto holds = [](const Estimate& one, double value) {
    const Interval at = confidence_interval(one);
    return at.low <= value && value <= at.high;
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto rounds = rounds_of(robot, 1, true, SquareMethod::exact, random);
    const SquareCorrections found = corrections_after(rounds[0], SquareMethod::exact);
    wheelbase_held += holds(found.wheelbase, kSquare.wheelbase * truth.wheelbase_ratio) ? 1 : 0;
    factor_held += holds(found.left_factor, truth.left_factor()) ? 1 : 0;
  }
  // Satterthwaite's degrees of freedom are an approximation: 95 % within four standard errors.
  EXPECT_NEAR(wheelbase_held / double{kTrials}, 0.95, 0.06);
  EXPECT_NEAR(factor_held / double{kTrials}, 0.95, 0.06);
}

TEST(GeometryErrorsWithScale, GoIntoAModelAndComeBack) {
  const GeometryErrors truth{1.004, 0.98, 1.03};
  Model model;
  set_geometry_errors(model, truth);
  ASSERT_EQ(model.effects.size(), 3U);
  const GeometryErrors back = geometry_errors(model);
  EXPECT_NEAR(back.diameter_ratio, truth.diameter_ratio, 1e-15);
  EXPECT_NEAR(back.wheelbase_ratio, truth.wheelbase_ratio, 1e-15);
  EXPECT_NEAR(back.scale, truth.scale, 1e-15);
  set_geometry_errors(model, {});
  EXPECT_EQ(geometry_errors(model).scale, 1.0);
  model.effects.back().coefficients = {-1.5};
  EXPECT_THROW((void)geometry_errors(model), std::invalid_argument);
}

TEST(PathErrorWithScale, IsThatOfTheRobotThatDrives) {
  const GeometryErrors truth{1.004, 0.98, 1.03};
  const TestPath path = parse_path("3,a70,2@-40,-1,a-200,eight@0.7");
  std::mt19937_64 unused;
  const Pose driven = drive_once(robot_of(truth), path, unused);
  const PathError found = path_error(path, kSquare.wheelbase, truth);
  EXPECT_NEAR(found.error[0], driven.x, 1e-12);
  EXPECT_NEAR(found.error[1], driven.y, 1e-12);
  EXPECT_NEAR(found.error[2], driven.heading, 1e-12);
}

TEST(FigureEight, ShowsTheWheelbaseByItsEndAndTheWheelsByItsHeadingAlone) {
  constexpr double kRadius = 1.5;
  const TestPath path = figure_eight_path(kRadius);
  EXPECT_LT(path_error(path, kSquare.wheelbase, {}).error.norm(), 1e-13);
  const double circle = 2.0 * std::numbers::pi;
  const double small = 1e-5;
  // What a circle lacks is circle (1 - 1/E_b); it turns too far by (E_d - 1) 2 pi R / b.
  const Eigen::Vector3d by_base = path_error(path, kSquare.wheelbase, {1.0, 1.0 + small}).error;
  EXPECT_NEAR(by_base[0] / small, -2.0 * kRadius * circle, 1e-3);
  EXPECT_NEAR(by_base[1] / small, 0.0, 1e-3);
  EXPECT_NEAR(by_base[2] / small, 0.0, 1e-6);
  const Eigen::Vector3d by_wheels = path_error(path, kSquare.wheelbase, {1.0 + small, 1.0}).error;
  EXPECT_LT(by_wheels.head<2>().norm() / small, 0.02);
  EXPECT_NEAR(by_wheels[2] / small, 2.0 * circle * kRadius / kSquare.wheelbase, 1e-2);
}

TEST(FigureEight, OfTwoSquaresShowsBothByItsEnd) {
  // To first order the ends of both squares add up: -4 L alpha ahead, -4 L beta to the left. So
  // the papers' word holds of circles, not of squares.
  const double small = 1e-6;
  TestPath path = square_path(kSquare.side, Direction::ccw);
  const TestPath other = square_path(kSquare.side, Direction::cw);
  path.insert(path.end(), other.begin(), other.end());
  const double alpha = std::numbers::pi / 2.0 * small;
  const double beta = small * kSquare.side / kSquare.wheelbase;
  const Eigen::Vector3d by_base = path_error(path, kSquare.wheelbase, {1.0, 1.0 + small}).error;
  EXPECT_NEAR(by_base[0] / alpha, -4.0 * kSquare.side, 1e-3);
  EXPECT_NEAR(by_base[1] / alpha, 0.0, 1e-3);
  const Eigen::Vector3d by_wheels = path_error(path, kSquare.wheelbase, {1.0 + small, 1.0}).error;
  EXPECT_NEAR(by_wheels[0] / beta, 0.0, 1e-1);
  EXPECT_NEAR(by_wheels[1] / beta, -4.0 * kSquare.side, 1e-1);
}

TEST(FigureEight, AloneHidesWhatTheSquaresShow) {
  // Borenstein & Feng (1996), 3.1: it "can be shown to have the same shortcomings as the
  // uni-directional square path".
  const GeometryErrors errors{1.002, 0.98};
  const PathTuning tuned = tune_by_path(errors, kSquare, figure_eight_path(1.5));
  EXPECT_GT(tuned.error_before, 0.3);
  EXPECT_LT(tuned.error_after, 0.01);
  // What is left is beta: 2 sqrt(2) L beta, both ways.
  const double beta = (errors.right_factor() - errors.left_factor()) * kSquare.side /
                      (kSquare.wheelbase * tuned.wheelbase_ratio);
  EXPECT_NEAR(tuned.square_cw, 2.0 * std::sqrt(2.0) * kSquare.side * beta, 0.01);
  EXPECT_NEAR(tuned.square_ccw, tuned.square_cw, 0.02);
  const OneWayTuning one_way = tune_one_way(errors, kSquare, Direction::ccw);
  EXPECT_EQ(tune_by_path(errors, kSquare, square_path(kSquare.side, Direction::ccw)).square_cw,
            one_way.error_other_way);
}

}  // namespace
}  // namespace trussmap::square_headings_test
