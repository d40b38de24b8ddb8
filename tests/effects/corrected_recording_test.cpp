// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a model's effects make of a recording.
#include "effects/corrected_recording.hpp"

#include "drive/row_variables.hpp"
#include "driven.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::corrected_recording_test {
namespace {

constexpr double kWheelbase = 0.5;

DrivenRecording recording() {
  DrivenRecording r;
  r.drive.t = {1.0, 2.0, 3.0};
  testing::add_travels(r.drive, 0.2, 0.2, kWheelbase);
  testing::add_travels(r.drive, -0.1, 0.1, kWheelbase);
  testing::add_travels(r.drive, 0.4, 0.6, kWheelbase);
  r.drive.heading = {0.1, 0.5, 0.9};
  r.drive.covariates.push_back({"payload_kg", {0.0, 10.0, 20.0}});
  r.sightings.push_back({1.5, "A", 2.0, 3.1});
  r.sightings.push_back({3.0, "B", kAbsent, kAbsent});
  return r;
}

DrivenRecording corrected(Channel channel, const Shape& shape, double coefficient) {
  Model model;
  model.robot.wheelbase = kWheelbase;
  model.effects.push_back({"test", channel, {shape}, {coefficient}, false});
  const DrivenRecording r = recording();
  return effects::corrected_recording(
      r, model,
      drive::row_variables(r.drive, Robot{.wheelbase = kWheelbase}, {}, std::vector<Pose>(3), 0),
      0);
}

/// Against formats.md's table, row 3: travel 0.5 m, turn 0.4 rad, 1 s.
TEST(CorrectedRecording, EveryWheelChannelDoesWhatTheTableSays) {
  struct Row {
    Channel channel;
    double travel, turn;
  };
  const double g = 0.1;
  for (const Row& row : {Row{Channel::travel, 0.55, 0.4}, Row{Channel::wheels, 0.55, 0.44},
                         Row{Channel::left, 0.52, 0.32}, Row{Channel::right, 0.53, 0.52},
                         Row{Channel::difference, 0.505, 0.5}, Row{Channel::turn, 0.5, 0.44},
                         Row{Channel::drift, 0.5, 0.5}, Row{Channel::advance, 0.6, 0.4},
                         Row{Channel::rotate, 0.5, 0.5}}) {
    const MotionRows drive = corrected(row.channel, "1", g).drive;
    EXPECT_NEAR(drive.forward[2], row.travel, 1e-14) << name_of(row.channel);
    EXPECT_NEAR(drive.turn[2], row.turn, 1e-14) << name_of(row.channel);
  }
}

TEST(CorrectedRecording, ShapesAreEvaluatedRowByRow) {
  const MotionRows drive = corrected(Channel::left, "payload_kg", 0.01).drive;
  EXPECT_NEAR(drive.pair.left[0], 0.2, 1e-15);
  EXPECT_NEAR(drive.pair.left[1], -0.11, 1e-15);
  EXPECT_NEAR(drive.pair.left[2], 0.48, 1e-15);
}

TEST(CorrectedRecording, ReadingsLoseWhatWasAdded) {
  EXPECT_NEAR(corrected(Channel::compass, "1", 0.05).drive.heading[1], 0.45, 1e-15);
  EXPECT_NEAR(corrected(Channel::range, "1", 0.5).sightings[0].range, 1.5, 1e-15);
  EXPECT_NEAR(corrected(Channel::range_scale, "1", 0.25).sightings[0].range, 1.6, 1e-15);
  EXPECT_NEAR(corrected(Channel::bearing, "1", -0.1).sightings[0].bearing, 3.2 - 2.0 * M_PI, 1e-14);
  EXPECT_TRUE(corrected(Channel::range, "1", 0.5).sightings[1].standing());
}

std::string complaint(Channel channel, const Shape& shape, double coefficient) {
  try {
    (void)corrected(channel, shape, coefficient);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(CorrectedRecording, RefusesWithTheEffectsName) {
  EXPECT_EQ(
      complaint(Channel::creep, "1", 0.1),
      "effect \"test\": has channel \"creep\", which only an adjustment can take into account");
  EXPECT_EQ(complaint(Channel::turn, "fuel", 0.1).rfind("effect \"test\": shape \"fuel\" names", 0),
            0U);
  EXPECT_EQ(complaint(Channel::range, "1", 5.0),
            "effect \"test\": leaves a range of -3 m at t = 1.5 s");
}

}  // namespace
}  // namespace trussmap::corrected_recording_test
