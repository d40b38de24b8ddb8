// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a model's effects make of a recording.
#include "effects/corrected_recording.hpp"

#include "trussmap/channel.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

constexpr double kWheelbase = 0.5;

Recording recording() {
  Recording r;
  r.drive.t = {1.0, 2.0, 3.0};
  r.drive.left = {0.2, -0.1, 0.4};
  r.drive.right = {0.2, 0.1, 0.6};
  r.drive.heading = {0.1, 0.5, 0.9};
  r.drive.covariates.push_back({"payload_kg", {0.0, 10.0, 20.0}});
  r.sightings.push_back({1.5, "A", 2.0, 3.1});
  r.sightings.push_back({3.0, "B", kAbsent, kAbsent});
  return r;
}

Recording corrected(const std::string& channel, const std::string& shape, double coefficient) {
  Model model;
  model.robot.wheelbase = kWheelbase;
  model.effects.push_back({"test", channel, {shape}, {coefficient}, false});
  const Recording r = recording();
  return corrected_recording(r, model,
                             row_variables(r.drive, kWheelbase, {}, std::vector<Pose>(3), 0), 0);
}

/// Against formats.md's table, row 3: travel 0.5 m, turn 0.4 rad, 1 s.
TEST(CorrectedRecording, EveryWheelChannelDoesWhatTheTableSays) {
  struct Row {
    const char* channel;
    double travel, turn;
  };
  const double g = 0.1;
  for (const Row& row :
       {Row{"travel", 0.55, 0.4}, Row{"wheels", 0.55, 0.44}, Row{"left", 0.52, 0.32},
        Row{"right", 0.53, 0.52}, Row{"difference", 0.505, 0.5}, Row{"turn", 0.5, 0.44},
        Row{"drift", 0.5, 0.5}, Row{"advance", 0.6, 0.4}, Row{"rotate", 0.5, 0.5}}) {
    const Drive drive = corrected(row.channel, "1", g).drive;
    EXPECT_NEAR(0.5 * (drive.left[2] + drive.right[2]), row.travel, 1e-14) << row.channel;
    EXPECT_NEAR((drive.right[2] - drive.left[2]) / kWheelbase, row.turn, 1e-14) << row.channel;
  }
}

TEST(CorrectedRecording, ShapesAreEvaluatedRowByRow) {
  const Drive drive = corrected("left", "payload_kg", 0.01).drive;
  EXPECT_NEAR(drive.left[0], 0.2, 1e-15);
  EXPECT_NEAR(drive.left[1], -0.11, 1e-15);
  EXPECT_NEAR(drive.left[2], 0.48, 1e-15);
}

TEST(CorrectedRecording, ReadingsLoseWhatWasAdded) {
  EXPECT_NEAR(corrected("compass", "1", 0.05).drive.heading[1], 0.45, 1e-15);
  EXPECT_NEAR(corrected("range", "1", 0.5).sightings[0].range, 1.5, 1e-15);
  EXPECT_NEAR(corrected("range_scale", "1", 0.25).sightings[0].range, 1.6, 1e-15);
  EXPECT_NEAR(corrected("bearing", "1", -0.1).sightings[0].bearing, 3.2 - 2.0 * M_PI, 1e-14);
  EXPECT_TRUE(corrected("range", "1", 0.5).sightings[1].standing());
}

std::string complaint(const std::string& channel, const std::string& shape, double coefficient) {
  try {
    (void)corrected(channel, shape, coefficient);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(CorrectedRecording, RefusesWithTheEffectsName) {
  EXPECT_EQ(
      complaint("creep", "1", 0.1),
      "effect \"test\": has channel \"creep\", which only an adjustment can take into account");
  EXPECT_EQ(complaint("steer", "1", 0.1)
                .rfind("effect \"test\": has channel \"steer\", which is "
                       "unknown, expected one of travel, left,",
                       0),
            0U);
  EXPECT_EQ(complaint("turn", "fuel", 0.1).rfind("effect \"test\": shape \"fuel\" names", 0), 0U);
  EXPECT_EQ(complaint("range", "1", 5.0), "effect \"test\": leaves a range of -3 m at t = 1.5 s");
}

TEST(Channels, HaveOneNameEach) {
  EXPECT_EQ(channels().size(), 17U);
  for (const ChannelFacts& one : channels()) {
    EXPECT_EQ(parse_channel(one.name), one.channel);
    EXPECT_EQ(facts_of(one.channel).name, one.name);
    EXPECT_GT(one.prior_sd, 0.0);
  }
  EXPECT_EQ(parse_channel("Turn"), std::nullopt);
}

}  // namespace
}  // namespace trussmap
