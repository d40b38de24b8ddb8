// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Straight runs, turns and rests beside a tape, of robots whose faults are known.
#include "trussmap/simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::tape_test {
namespace {

constexpr double kWheelbase = 0.34;
constexpr double kTenTurns = 20.0 * std::numbers::pi;

TapedRun straight(double expected, double odometry) {
  TapedRun run;
  run.expected = expected;
  run.odometry = odometry;
  return run;
}

TapedRun spin(double expected, double odometry, double seconds = kAbsent) {
  TapedRun run;
  run.kind = TapedKind::spin;
  run.expected = expected;
  run.odometry = odometry;
  run.seconds = seconds;
  return run;
}

TapedRun rest(double gyro, double seconds) {
  TapedRun run;
  run.kind = TapedKind::rest;
  run.gyro = gyro;
  run.seconds = seconds;
  return run;
}

/// How a robot is tried: by five straight runs of 6 and 10 m, and turns of different size.
struct Afternoon {
  double tape_sd = 0.003;     // m
  double heading_sd = 0.002;  // rad
  bool stated = false;
  bool timed = false;
};

std::vector<TapedRun> driven(const TapeRobot& robot, const Afternoon& how,
                             std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<TapedRun> runs;
  for (int k = 0; k < 5; ++k) {
    const double length = k % 2 == 0 ? 10.0 : 6.0;
    const Pose end = drive_once(robot, {{length, 0.0}}, random);
    TapedRun run =
        straight(std::hypot(length + end.x, end.y) + how.tape_sd * normal(random), length);
    run.heading = end.heading + how.heading_sd * normal(random);
    if (how.stated) run.sd = how.tape_sd;
    if (how.stated) run.sd_heading = how.heading_sd;
    runs.push_back(run);
  }
  for (int k = 0; k < 8; ++k) {
    const double turn = (k % 2 == 0 ? 1.0 : -1.0) * (k < 4 ? 1.0 : 0.5) * kTenTurns;
    const Pose end = drive_once(robot, {{0.0, turn}}, random);
    TapedRun run = spin(turn + end.heading + how.heading_sd * normal(random), turn);
    if (how.timed) run.seconds = std::abs(turn) / (k % 4 < 2 ? 0.4 : 1.0);
    if (how.stated) run.sd = how.heading_sd;
    runs.push_back(run);
  }
  return runs;
}

TapeRobot robot_with(double e_d, double e_b, double e_s) {
  TapeRobot robot = misbuilt_robot(kWheelbase, e_d, e_b);
  robot.left_share *= e_s;
  robot.right_share *= e_s;
  return robot;
}

TEST(TapeCalibration, IsExactWithoutNoise) {
  std::mt19937_64 random(1);
  const TapeCalibration found =
      calibrate_by_tape(driven(robot_with(1.02, 0.95, 1.03), {0.0, 0.0}, random), kWheelbase);
  EXPECT_NEAR(found.scale->value, 1.03, 1e-9);
  EXPECT_NEAR(found.diameter_ratio->value, 1.02, 1e-9);
  EXPECT_NEAR(found.wheelbase_ratio->value, 0.95, 1e-9);
  EXPECT_NEAR(found.turn_factor->value, 1.03 / 0.95, 1e-9);
  EXPECT_TRUE(found.doubts.empty());
}

/// 600 afternoons each; 95 % have a standard error of 0.9 %: 91 and 98.6 % are four of them away.
void expect_coverage(bool stated, std::uint64_t seed) {
  constexpr int kTrials = 600;
  const TapeRobot robot = robot_with(1.004, 0.98, 1.01);
  std::mt19937_64 random(seed);
  int hits[3] = {0, 0, 0};
  int doubted = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const TapeCalibration found =
        calibrate_by_tape(driven(robot, {.stated = stated, .timed = true}, random), kWheelbase);
    const std::pair<Estimate, double> all[] = {
        {*found.scale, 1.01}, {*found.diameter_ratio, 1.004}, {*found.wheelbase_ratio, 0.98}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Interval at = confidence_interval(all[k].first);
      hits[k] += at.low <= all[k].second && all[k].second <= at.high ? 1 : 0;
    }
    doubted += found.doubts.empty() ? 0 : 1;
  }
  for (const int one : hits) {
    EXPECT_GE(one, 0.91 * kTrials);
    EXPECT_LE(one, 0.986 * kTrials);
  }
  EXPECT_LE(doubted, 0.03 * kTrials);  // healthy runs: some ten tests at 0.001
}

TEST(TapeCalibration, IntervalsHoldTheTruthByTheRunsScatter) {
  expect_coverage(false, 2);
}

TEST(TapeCalibration, IntervalsHoldTheTruthByErrorsThatAreStated) {
  expect_coverage(true, 3);
}

TEST(TapeCalibration, TenTurnsOnTheSpotAreAWheelbaseOrTurningAsAWhole) {
  const double degree = std::numbers::pi / 180.0;
  TapedRun run = spin(3600.0 * degree, 3578.1 * degree);
  const TapeCalibration one = calibrate_by_tape({run}, 0.23);
  EXPECT_NEAR(one.wheelbase_ratio->value, 3578.1 / 3600.0, 1e-12);
  EXPECT_EQ(one.wheelbase_ratio->dof, 0.0);  // one turn has no standard error
  EXPECT_EQ(tape_verdict(one), TapeVerdict::unsure);
  run.sd = 2.0 * degree;
  const TapeCalibration found = calibrate_by_tape({run}, 0.23);
  EXPECT_NEAR(found.wheelbase_ratio->standard_error, 0.99392 * 2.0 / 3600.0, 1e-6);
  EXPECT_EQ(tape_verdict(found), TapeVerdict::worth_correcting);
  EXPECT_EQ(found.look_alikes,
            (std::vector<std::string>{"wheel scale", "turn asymmetry", "turn scrub"}));
  EXPECT_FALSE(found.diameter_ratio || found.scale);
  Model model;
  model.robot.wheelbase = 0.23;
  set_taped(model, found);
  ASSERT_EQ(model.effects.size(), 1U);  // nothing of what was not determined
  EXPECT_EQ(model.effects[0].name, "wheelbase");
  EXPECT_NEAR(model.effects[0].coefficients[0], 3600.0 / 3578.1 - 1.0, 1e-12);
}

TEST(TapeCalibration, EndsAsideTellNothingOfTheWheelsUnlessTheStartIsKnown) {
  std::vector<TapedRun> runs;
  for (const double aside : {0.2007, 0.2003, 0.2020}) {
    runs.push_back(straight(std::hypot(4.99, aside), 5.0));
    runs.back().aside = aside;
  }
  const TapeCalibration unknown = calibrate_by_tape(runs, 0.287);
  EXPECT_FALSE(unknown.diameter_ratio);
  EXPECT_NE(unknown.undetermined.front().find("E_d"), std::string::npos);
  EXPECT_NE(unknown.undetermined.front().find("aimed 2.3 deg askew"), std::string::npos)
      << unknown.undetermined.front();
  for (TapedRun& run : runs) run.sd_start = 0.02;
  const TapeCalibration aimed = calibrate_by_tape(runs, 0.287);
  ASSERT_TRUE(aimed.diameter_ratio);
  // y = L^2 h / (2 D): h = 0.0805 rad, E_d - 1 = h b / D; the start is off alike in all runs.
  EXPECT_NEAR(aimed.diameter_ratio->value, 1.0 + 0.0805 * 0.287 / 5.0, 3e-5);
  EXPECT_NEAR(aimed.diameter_ratio->standard_error, 2.0 * 0.02 * 0.287 / 5.0, 3e-5);
  EXPECT_FALSE(is_off(aimed.diameter_ratio, 1.0));
}

TEST(TapeCalibration, RunsThatContradictEachOtherAreDoubtfulAndTheirErrorsWider) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const auto turns = [&](auto&& factor) {
    std::vector<TapedRun> runs;
    for (int k = 0; k < 12; ++k) {
      const double size = (k % 3 == 0 ? 0.4 : 1.0) * kTenTurns;
      const double side = k % 2 == 0 ? 1.0 : -1.0;
      const double rate = k % 4 < 2 ? 0.3 : 1.2;
      const double turned = side * (size * factor(side, rate) + 0.01 * normal(random));
      runs.push_back(spin(turned, side * size, size / rate));
    }
    return calibrate_by_tape(runs, kWheelbase);
  };
  const TapeCalibration healthy = turns([](double, double) { return 1.01; });
  EXPECT_TRUE(healthy.doubts.empty());
  EXPECT_EQ(healthy.look_alikes, std::vector<std::string>{"wheel scale"});
  const TapeCalibration sides = turns([](double side, double) { return 1.01 + 0.004 * side; });
  const TapeCalibration rates = turns([](double, double rate) { return 1.01 - 0.01 * rate; });
  for (const auto& [found, word] :
       {std::pair(sides, "turn asymmetry"), std::pair(rates, "turn scrub")}) {
    ASSERT_EQ(found.doubts.size(), 1U) << word;
    EXPECT_NE(found.doubts[0].find(word), std::string::npos) << found.doubts[0];
    EXPECT_EQ(tape_verdict(found), TapeVerdict::doubtful);
    EXPECT_GT(found.wheelbase_ratio->standard_error,
              10.0 * healthy.wheelbase_ratio->standard_error);
  }
  std::vector<TapedRun> runs;
  for (const double length : {2.0, 4.0, 6.0, 8.0, 10.0}) {
    runs.push_back(straight(length + 0.15 + 0.001 * normal(random), length));  // from the bumper
  }
  const TapeCalibration bumper = calibrate_by_tape(runs, kWheelbase);
  ASSERT_FALSE(bumper.doubts.empty());
  EXPECT_NE(bumper.doubts[0].find("short or long, is 1.5e+02 mm longer"), std::string::npos)
      << bumper.doubts[0];
  EXPECT_LT(std::abs(bumper.scale->value - 1.0), 3.0 * bumper.scale->standard_error);
}

/// 400 trials; theta = (1 + s) G - g t, with an angle random walk of the gyro.
TEST(TapeCalibration, TheGyrosScaleAndBiasComeWithErrorsThatHold) {
  constexpr double kScale = 0.02;
  constexpr double kBias = 0.011;
  constexpr double kWalk = 5e-4;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto reading = [&](double turned, double seconds) {
    return (turned + kBias * seconds) / (1.0 + kScale) +
           kWalk * std::sqrt(seconds) * normal(random);
  };
  for (const bool rests : {true, false}) {
    int hits[2] = {0, 0};
    for (int trial = 0; trial < 400; ++trial) {
      std::vector<TapedRun> runs;
      for (int k = 0; k < 8; ++k) {
        const double turned = (k % 2 == 0 ? 1.0 : -1.0) * kTenTurns;
        runs.push_back(spin(turned + 0.002 * normal(random), turned, 60.0));
        runs.back().gyro = reading(turned, 60.0);
      }
      for (int k = 0; k < 5 && rests; ++k) runs.push_back(rest(reading(0.0, 60.0), 60.0));
      const TapeCalibration found = calibrate_by_tape(runs, kWheelbase);
      const std::pair<Estimate, double> both[] = {{*found.gyro_scale, kScale},
                                                  {*found.gyro_bias, kBias}};
      for (std::size_t k = 0; k < 2; ++k) {
        const Interval at = confidence_interval(both[k].first);
        hits[k] += at.low <= both[k].second && both[k].second <= at.high ? 1 : 0;
      }
    }
    for (const int one : hits) {  // 95 % of 400: 1.1 % standard error
      EXPECT_GE(one, 0.905 * 400) << rests;
      EXPECT_LE(one, 0.995 * 400) << rests;
    }
  }
}

TEST(TapeCalibration, WhatWasInForceIsMultipliedIn) {
  const TapeRobot robot = robot_with(1.004, 0.98, 1.01);
  Model model;
  model.robot.wheelbase = kWheelbase;
  std::mt19937_64 random(6);
  for (int round = 0; round < 2; ++round) {
    const GeometryErrors in_force = geometry_errors(model);
    const double believed = kWheelbase * in_force.wheelbase_ratio;
    const TapeRobot corrected =
        reprogrammed(robot, in_force.left_factor(), in_force.right_factor(), believed);
    std::vector<TapedRun> runs = driven(corrected, {1e-3, 1e-3}, random);
    runs.push_back(rest(0.6, 60.0));
    set_taped(model, calibrate_by_tape(runs, believed));
  }
  const GeometryErrors all = geometry_errors(model);
  EXPECT_NEAR(all.scale, 1.01, 5e-4);
  EXPECT_NEAR(all.diameter_ratio, 1.004, 3e-4);
  EXPECT_NEAR(all.wheelbase_ratio, 0.98, 5e-4);
  EXPECT_EQ(model.effects.back().name, "gyro bias");
  EXPECT_NEAR(model.effects.back().coefficients[0], 0.02, 1e-12);  // 0.01 twice
}

TEST(TapeCalibration, RefusesWhatIsNoRun) {
  EXPECT_THROW(static_cast<void>(calibrate_by_tape({}, 0.3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate_by_tape({straight(1.0, 1.0)}, 0.0)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate_by_tape({straight(-1.0, 1.0)}, 0.3)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate_by_tape({spin(1.0, -1.0)}, 0.3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate_by_tape({rest(1.0, kAbsent)}, 0.3)),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::tape_test
