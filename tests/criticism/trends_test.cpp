// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/trends.hpp"

#include "criticism/noisy_recordings.hpp"
#include "driven.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::trends_test {
namespace {

using testing::NoisyDrive;
using testing::simulate_world;

/// Every row cut into `parts` of equal length; the compass is read at the end of the last.
DrivenRecording split(const DrivenRecording& whole, int parts) {
  DrivenRecording result = whole;
  MotionRows& drive = result.drive;
  drive = {};
  for (const Covariate& one : whole.drive.covariates) drive.covariates.push_back({one.name, {}});
  for (std::size_t row = 0; row < whole.drive.rows(); ++row) {
    for (int part = 1; part <= parts; ++part) {
      drive.t.push_back(whole.drive.t[row] -
                        whole.drive.duration(row) * (1.0 - static_cast<double>(part) / parts));
      testing::add_travels(drive, whole.drive.pair.left[row] / parts,
                           whole.drive.pair.right[row] / parts);
      if (whole.drive.has_compass()) {
        drive.heading.push_back(part == parts ? whole.drive.heading[row] : kAbsent);
      }
      for (std::size_t c = 0; c < drive.covariates.size(); ++c) {
        drive.covariates[c].values.push_back(whole.drive.covariates[c].values[row]);
      }
    }
  }
  return result;
}

/// Turn rate from which on the trend against the sense of turning counts a turn, rad/s.
double least_turn(const std::vector<DrivenRecording>& recordings, const Model& model) {
  const fitting::FitState fit = fitting::fit_recordings(recordings, model);
  for (const Trend& trend : criticism::find_trends(fit, criticism::ScoreTest(fit))) {
    if (trend.against != "turn sense") continue;
    return std::abs(trend.effect.shape.front().parameter("turn_rate").value_or(0.0));
  }
  return 0.0;
}

TEST(Trends, WhatCountsAsATurnDoesNotHangOnTheRateOfLogging) {
  const NoisyDrive world = simulate_world({}, 3);
  std::vector<DrivenRecording> finer;
  for (const DrivenRecording& one : world.recordings) finer.push_back(split(one, 5));
  const double least = least_turn(world.recordings, world.model);
  EXPECT_GT(least, 0.005);  // k = 0.003 on straights of 0.25 m/s and more, B = 0.34 m
  EXPECT_LT(least, 0.2);
  EXPECT_NEAR(least_turn(finer, world.model), least, 0.25 * least);
}

}  // namespace
}  // namespace trussmap::trends_test
