// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::mrclam_reader_test {
namespace {

using testing::ScratchFolder;

/// A robot that drives at 1 m/s from 100.0 to 101.0 s, and sees what `measurements` says. Barcode 5
/// is robot 5; 63 and 72 are landmarks 6 and 7.
std::filesystem::path robot_in(const ScratchFolder& scratch, const std::string& measurements) {
  scratch.write("Barcodes.dat", "# subject barcode\n5 14\n6 63\n7 72\n");
  scratch.write("Robot1_Odometry.dat", "100.0 1 0\n100.2 1 0\n100.4 1 0\n100.4 1 0\n101.0 1 0\n");
  scratch.write("Robot1_Measurement.dat", measurements);
  return scratch.path() / "Robot1";
}

std::vector<double> times_of(const Dataset& read) {
  std::vector<double> times;
  for (const Sighting& one : read.recording.sightings) times.push_back(one.t);
  return times;
}

TEST(MrclamReader, ASightingBeforeTheStartOrAfterTheEndIsOutsideTheDrive) {
  const ScratchFolder scratch;
  const Dataset read = datasets::read_mrclam(robot_in(scratch,
                                                      "99.99 63 1 0\n"      // before
                                                      "100.0 63 1 0.1\n"    // at the start
                                                      "100.7 72 2 -0.1\n"   // within
                                                      "101.0 63 3 0\n"      // at the end
                                                      "101.01 72 2 0\n"));  // after
  EXPECT_EQ(read.recording.drive.start(), 0.0);
  EXPECT_EQ(times_of(read), (std::vector<double>{0.0, 0.7, 1.0}));
  EXPECT_EQ(read.figure("outside_drive"), 2);
  EXPECT_EQ(read.figure("merged_times"), 1);
  ASSERT_EQ(read.recording.sightings.size(), 3U);
  EXPECT_EQ(read.recording.sightings[1].landmark, "7");
  EXPECT_EQ(read.recording.sightings[1].range, 2.0);
  EXPECT_EQ(read.recording.sightings[1].bearing, -0.1);
}

TEST(MrclamReader, CountsRobotsUnknownBarcodesAndFrames) {
  const ScratchFolder scratch;
  const Dataset read =
      datasets::read_mrclam(robot_in(scratch,
                                     "100.1 14 1 0\n"       // a robot
                                     "100.1 99 1 0\n"       // nobody's
                                     "100.500 63 1 0\n"     // a frame: 5 ms apart at most
                                     "100.504 72 1 0\n"     //
                                     "100.506 63 1 0\n"     // 6 ms after its first
                                     "100.300 72 1 0\n"));  // earlier than the one before
  EXPECT_EQ(read.figure("robots_seen"), 1);
  EXPECT_EQ(read.figure("unknown_barcodes"), 1);
  EXPECT_EQ(read.figure("outside_drive"), 0);
  EXPECT_EQ(read.figure("unordered_sightings"), 1);
  EXPECT_EQ(read.figure("same_frame"), 1);
  EXPECT_EQ(times_of(read), (std::vector<double>{0.3, 0.5, 0.5, 0.506}));
}

TEST(MrclamReader, TruthEndsWithTheDrive) {
  const ScratchFolder scratch;
  const auto prefix = robot_in(scratch, "100.5 63 1 0\n");
  scratch.write(
      "Robot1_Groundtruth.dat",
      "99.9 9 9 9\n100.0 1 2 0.1\n100.0 9 9 9\n100.5 3 4 0.2\n101.0 5 6 0.3\n101.1 9 9 9\n");
  const Dataset read = datasets::read_mrclam(prefix);
  ASSERT_EQ(read.recording.truth.size(), 3U);
  EXPECT_EQ(read.recording.truth[0].x, 1.0);
  EXPECT_EQ(read.recording.truth[1].y, 4.0);
  EXPECT_EQ(read.recording.truth[2].heading, 0.3);
}

}  // namespace
}  // namespace trussmap::mrclam_reader_test
