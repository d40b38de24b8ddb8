// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Ranges to radio beacons: the files, and a lawn mower's map and path of odometry and ranges alone.
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::radio_ranges_test {
using namespace datasets;
namespace {

using testing::ScratchFolder;

TEST(RadioRanges, BecomeARecording) {
  const ScratchFolder scratch;
  scratch.write("a_DR.txt", "100.5 0.10 0.02\n101.0 0.20 0\n101.5 0.30 -0.02\n");
  scratch.write("a_TD.txt", "101.2 2 7 3.5\n100.9 2 0 4\n99 2 7 1\n");
  const Dataset read = read_radio_ranges(scratch.path() / "a");
  EXPECT_TRUE(is_radio_ranges(scratch.path() / "a"));
  EXPECT_FALSE(is_radio_ranges(scratch.path() / "b"));
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 3U);
  EXPECT_EQ(drive.t.front(), 0.5);
  EXPECT_NEAR(0.5 * (drive.left[0] + drive.right[0]), 0.10, 1e-12);
  EXPECT_NEAR((drive.right[0] - drive.left[0]) / read.model.robot.wheelbase, 0.02, 1e-12);
  ASSERT_EQ(read.recording.sightings.size(), 2U);
  EXPECT_EQ(read.recording.sightings[0].landmark, "0");
  EXPECT_EQ(read.recording.sightings[1].range, 3.5);
  EXPECT_FALSE(read.recording.sightings[1].locates());
  EXPECT_EQ(read.figure("outside_drive"), 1);
  EXPECT_EQ(read.figure("unordered_ranges"), 1);
}

TEST(RadioRanges, BadFilesAreRefused) {
  const ScratchFolder scratch;
  const auto refused = [&](const std::string& drive, const std::string& ranges) {
    scratch.write("a_DR.txt", drive);
    scratch.write("a_TD.txt", ranges);
    EXPECT_THROW(static_cast<void>(read_radio_ranges(scratch.path() / "a")), InputError);
  };
  const std::string drive = "100.5 0.10 0.02\n101.0 0.20 0\n";
  refused("100.5 0.10\n", "101 2 7 3.5\n");
  refused("100.5 0.10 0.02\n100.5 0.20 0\n", "100.5 2 7 3.5\n");
  refused(drive, "100.9 2 7 -3.5\n");
  refused(drive, "100.9 2 7.5 3.5\n");
  refused(drive, "100.9 2 7 nan\n");
  refused(drive, "300 2 7 1\n");
  refused(drive, "");
  EXPECT_THROW(static_cast<void>(read_radio_ranges(scratch.path() / "b")), InputError);
}

/// Beacons where the data's TL has them (RTK GPS), path beside the truth, after the best rotation
/// and translation; nothing but odometry and ranges is used. Their ranges read 7 % too much.
TEST(SlowRadioRanges, MapALawnAndThePathOverIt) {
  TRUSSMAP_NEEDS_SHARED("data/plaza1");
  const Dataset read = read_radio_ranges(testing::shared("data/plaza1/Plaza1"));
  Recording recording = read.recording;
  const std::vector<TruthRow> truth = recording.truth;
  recording.truth.clear();
  Model model = read.model;
  model.effects.push_back(catalogue_effect("range scale"));
  const ModelFit fit = fit_model({recording}, model, {.gate = 16.0});
  EXPECT_NEAR(fit.effects.front().effect.coefficients.front(), 0.068, 0.008);

  const std::map<std::string, Vector2> beacons = {{"0", {-46.623234, 11.025549}},
                                                  {"1", {11.036124, -6.958689}},
                                                  {"6", {22.053129, 23.848482}},
                                                  {"5", {-17.664893, 59.009181}}};
  std::vector<Vector2> here, there;
  for (const FittedLandmark& one : fit.landmarks) {
    here.push_back(one.position);
    there.push_back(beacons.at(one.name));
  }
  EXPECT_LE(align_rigidly(here, there).rms, 0.6);

  const std::vector<TimedPose> poses = adjusted_poses(fit);
  here.clear();
  there.clear();
  std::size_t at = 0;
  for (const TruthRow& row : truth) {
    while (at + 1 < poses.size() && poses[at].t < row.t) ++at;
    if (std::abs(poses[at].t - row.t) > 0.05) continue;
    here.push_back(poses[at].estimate.pose.position());
    there.emplace_back(row.x, row.y);
  }
  ASSERT_GT(here.size(), 5000U);
  EXPECT_LE(align_rigidly(here, there).rms, 0.6);  // dead reckoning: 1.47 m
}

}  // namespace
}  // namespace trussmap::radio_ranges_test
