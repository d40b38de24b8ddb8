// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/misfits.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::misfits_test {
namespace {

TEST(Misfits, LegsAreAsMuchTooLongAsTheWheelsSay) {
  // A survey holds the map against wheels of little weight: what they say too much remains.
  constexpr double kTooMuch = 0.05;
  testing::SimulatedRecording one = testing::simulate_recording({true, true, false, 2}, 6);
  for (double& left : one.recording.drive.pair.left) left *= 1.0 + kTooMuch;
  for (double& right : one.recording.drive.pair.right) right *= 1.0 + kTooMuch;
  testing::retake(one.recording.drive);
  one.model.noise.left *= 10.0;
  one.model.noise.right *= 10.0;
  const fitting::FitState fit = fitting::fit_recordings({one.recording}, one.model);
  const criticism::Misfits misfits = criticism::find_misfits(fit, criticism::ScoreTest(fit), {});
  ASSERT_GT(misfits.legs.size(), 20U);
  double stretch = 0.0;
  double turn = 0.0;
  for (const LegMisfit& leg : misfits.legs) {
    EXPECT_NEAR(leg.stretch_error, kTooMuch, 0.04) << leg.from << " to " << leg.to;
    stretch += leg.stretch_error / static_cast<double>(misfits.legs.size());
    turn += leg.orientation_error / static_cast<double>(misfits.legs.size());
  }
  EXPECT_NEAR(stretch, kTooMuch, 0.01);
  EXPECT_NEAR(turn, 0.0, 0.01);
}

}  // namespace
}  // namespace trussmap::misfits_test
