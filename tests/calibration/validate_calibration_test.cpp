// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs that a calibration has not seen: which they are, and what they say.
#include "calibration/truth_holdout.hpp"
#include "driven.hpp"
#include "estimation/drawn_drive.hpp"
#include "trussmap/calibrate.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace trussmap::validate_calibration_test {
namespace {

using testing::draw;
using testing::DrawnRobot;
using testing::figure;
using testing::Stretch;

DrawnRobot robot_with(double scale) {
  DrawnRobot robot;
  robot.E_d = 1.01;
  robot.E_b = 0.95;
  robot.E_s = scale;
  robot.truth_sd = 0.0005;
  robot.truth_heading_sd = 0.002;
  return robot;
}

Model nominal() {
  Model model;
  model.noise.truth = 0.0005;
  model.noise.truth_heading = 0.002;
  return model;
}

/// 2.5 m straight, 1.6 rad on the spot, 1 m along an arc.
Recording short_run(const DrawnRobot& robot, std::uint64_t seed) {
  const double way = seed % 2 == 0 ? 1.0 : -1.0;
  return draw({{1.0, 0.0, 0.0},
               {5.0, 0.5, 0.0},
               {2.0, 0.0, way * 0.8},
               {2.0, 0.5, -way * 0.6},
               {1.0, 0.0, 0.0}},
              robot, seed);
}

double rms(const std::vector<double>& values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

TEST(ValidateCalibration, AFewShortRunsAreHeldOutOneByOne) {
  std::vector<Recording> runs;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    runs.push_back(short_run(robot_with(1.02), seed));
  }
  const std::size_t legs = calibration::truth_legs(testing::driven(runs), 0.3).size();
  ASSERT_GE(legs, 12U);
  const CalibrationValidation found = validate_calibration(runs, nominal());
  EXPECT_EQ(found.scheme, HoldoutScheme::recordings);
  EXPECT_EQ(found.nominal.distances.size(), legs);
  EXPECT_EQ(found.calibrated.distances.size(), legs);
  EXPECT_EQ(found.gain(), CalibrationGain::better);
  EXPECT_LT(3.0 * found.calibrated.rms(), found.nominal.rms());
}

/// The clock of a held-out run is set by that of the others.
TEST(ValidateCalibration, ALateClockIsTakenFromTheOtherRuns) {
  std::vector<Recording> runs;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    runs.push_back(short_run(robot_with(1.02), seed));
    for (TruthRow& row : runs.back().truth) row.t += 0.2;
  }
  const CalibrationValidation found = validate_calibration(runs, nominal());
  ASSERT_EQ(found.scheme, HoldoutScheme::recordings);
  EXPECT_LT(found.calibrated.rms(), 0.01);
}

TEST(ValidateCalibration, AHeldOutRunHasNoPartInItsPrediction) {
  // The first run's wheels measure 8 % less than those of all others. A calibration that has seen
  // it would share that out; by the others alone its legs end 8 % short.
  std::vector<Recording> runs = {
      draw({{1.0, 0.0, 0.0}, {8.0, 0.5, 0.0}, {1.0, 0.0, 0.0}}, robot_with(1.08), 1)};
  for (std::uint64_t seed = 2; seed <= 4; ++seed) {
    runs.push_back(short_run(robot_with(1.0), seed));
  }
  const std::size_t own = calibration::truth_legs({testing::driven(runs[0])}, 0.3).size();
  ASSERT_GE(own, 2U);
  const CalibrationValidation found = validate_calibration(runs, nominal());
  ASSERT_EQ(found.scheme, HoldoutScheme::recordings);
  // A leg is 1 m to 1.05 m by the wheels of this run.
  const auto& all = found.calibrated.distances;
  EXPECT_NEAR(rms({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(own)}), 0.082, 0.004);
}

TEST(ValidateCalibration, ALongDriveIsHeldOutInBlocks) {
  const std::vector<Recording> drives = {draw(figure(), robot_with(1.02)),
                                         draw(figure(), robot_with(1.02), 2)};
  const CalibrationValidation found = validate_calibration(drives, nominal());
  EXPECT_EQ(found.scheme, HoldoutScheme::blocks);
  EXPECT_EQ(found.legs(), 15);  // blocks 4, 7 and 10 of five legs each
  EXPECT_EQ(found.gain(), CalibrationGain::better);
}

TEST(ValidateCalibration, NoTruthOrNoHoldoutMeansNoLegs) {
  const std::vector<Recording> drive = {draw(figure(), robot_with(1.02))};
  CalibrationOptions options;
  options.holdout = 0.0;
  EXPECT_EQ(validate_calibration(drive, nominal(), options).scheme, HoldoutScheme::none);
  options = {};
  options.truth = false;
  EXPECT_EQ(validate_calibration(drive, nominal(), options).legs(), 0);
  // One run of a few legs leaves nothing to calibrate by.
  const CalibrationValidation one =
      validate_calibration({short_run(robot_with(1.0), 1)}, nominal());
  EXPECT_EQ(one.scheme, HoldoutScheme::none);
  EXPECT_EQ(one.gain(), CalibrationGain::unknown);
}

TEST(ValidateCalibration, TheVerdictNeedsAGainBeyondItsScatter) {
  const auto gain = [](std::vector<double> before, std::vector<double> after) {
    return CalibrationValidation{HoldoutScheme::blocks, {std::move(before)}, {std::move(after)}}
        .gain();
  };
  EXPECT_EQ(gain({3, 3, 3, 3}, {1, 1, 1, 1}), CalibrationGain::uncertain);  // four legs
  EXPECT_EQ(gain({3, 4, 3, 4, 3}, {1, 1, 1, 1, 1}), CalibrationGain::better);
  EXPECT_EQ(gain({1, 1, 1, 1, 1}, {3, 4, 3, 4, 3}), CalibrationGain::worse);
  // Gains 8, -8, 8, -8, 8: mean 1.6, standard error 7.84/2.
  EXPECT_EQ(gain({3, 1, 3, 1, 3}, {1, 3, 1, 3, 1}), CalibrationGain::uncertain);
}

}  // namespace
}  // namespace trussmap::validate_calibration_test
