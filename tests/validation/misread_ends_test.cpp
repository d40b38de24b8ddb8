// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Held-out legs among sightings under another landmark's name: the error told is the robot's, and
// a robot that was carried away does not pass for a misread label.
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/held_out.hpp"
#include "trussmap/simulated_recording.hpp"
#include "wrong_labels.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::misread_ends_test {
namespace {

SimulatedRecording hall(std::uint64_t seed) {
  Effect travel = catalogue_effect("travel scale");
  travel.coefficients = {0.03};
  return simulate(testing::seen_hall("5x5", seed), {travel});
}

HeldOut held_out_of(const Recording& recording, const Model& model) {
  const std::vector<DrivenRecording> drives = with_wheels(std::vector{recording}, model.robot);
  return predict_held_out(drives, fit_model(drives, model, gated_fit()));
}

/// Seeds 4 and 5, by the model without the effect and with it.
TEST(MisreadEnds, AreNoErrorOfTheRobot) {
  for (const std::uint64_t seed : {4U, 5U}) {
    const SimulatedRecording made = hall(seed);
    Recording spoilt = made.drive.recording;
    ASSERT_GT(testing::spoil_labels(spoilt, 0.04, seed).size(), 5U);
    Model with = made.model;
    with.effects = {catalogue_effect("travel scale")};
    for (const Model& model : {made.model, with}) {
      const HeldOut clean = held_out_of(made.drive.recording, model);
      const HeldOut found = held_out_of(spoilt, model);
      EXPECT_GT(found.legs.size(), clean.legs.size() * 3 / 4);
      EXPECT_NEAR(found.arrival_rms, clean.arrival_rms, 0.2 * clean.arrival_rms) << seed;
    }
  }
}

/// Carried 0.6 m on a held-out leg, to no landmark: that leg is told with its error. Seed 4.
TEST(MisreadEnds, ARobotThatWasCarriedStays) {
  const SimulatedRecording made = hall(4);
  const HeldOut before = held_out_of(made.drive.recording, made.model);
  ASSERT_GT(before.legs.size(), 5U);
  const LegPrediction& leg = before.legs[before.legs.size() / 2];
  Recording carried = made.drive.recording;
  const auto row = std::lower_bound(carried.drive.t.begin(), carried.drive.t.end(), leg.t - 1.0) -
                   carried.drive.t.begin();
  carried.drive.left[static_cast<std::size_t>(row)] -= 0.6;
  carried.drive.right[static_cast<std::size_t>(row)] -= 0.6;
  const HeldOut after = held_out_of(carried, made.model);
  const auto same = std::ranges::find(after.legs, leg.leg, &LegPrediction::leg);
  ASSERT_NE(same, after.legs.end());
  EXPECT_GT(same->arrival_error.norm(), 0.3);
}

}  // namespace
}  // namespace trussmap::misread_ends_test
