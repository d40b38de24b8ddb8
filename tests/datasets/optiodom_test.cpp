// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::optiodom_test {
using namespace datasets;
namespace {

using testing::ScratchFolder;

const std::string kMetadata = "type,diff,,\nngear,10,,\nencRes,84,,\nLi,0.2,,\n";

TEST(OptiOdom, TicksBecomeMetresOnTheRightWheels) {
  const ScratchFolder scratch;
  scratch.write("7_metadata.csv", kMetadata);
  const auto file = scratch.write("7_run-02.csv", "0,0,0,0,0,0\n0.05,0.1,0.2,7,30,-10\n");
  ASSERT_TRUE(is_optiodom(file));
  const Dataset read = read_optiodom(file);
  ASSERT_EQ(read.recording.drive.rows(), 2U);
  // 84 x 10 ticks are one turn of a wheel of pi 0.084 m: 0.1 pi mm a tick.
  EXPECT_NEAR(read.recording.drive.right[1], 30 * 1e-4 * M_PI, 1e-15);
  EXPECT_NEAR(read.recording.drive.left[1], -10 * 1e-4 * M_PI, 1e-15);
  ASSERT_EQ(read.recording.truth.size(), 2U);
  EXPECT_EQ(read.recording.truth[1].y, 0.2);
  EXPECT_NEAR(read.recording.truth[1].heading, 7.0 - 2.0 * M_PI, 1e-15);
}

TEST(OptiOdom, OnlyRunsAreRuns) {
  EXPECT_TRUE(is_optiodom("a/231220200121_run-01.csv.xz"));
  EXPECT_FALSE(is_optiodom("a/231220200121_run-01_odo.csv"));
  EXPECT_FALSE(is_optiodom("a/231220200121_run-.csv"));
  EXPECT_FALSE(is_optiodom("a/231220200121_metadata.csv"));
}

std::string complaint(const ScratchFolder& scratch, const std::string& metadata,
                      const std::string& rows) {
  scratch.write("1_metadata.csv", metadata);
  try {
    (void)read_optiodom(scratch.write("1_run-01.csv", rows));
  } catch (const InputError& error) {
    return std::string(error.what()).substr(scratch.path().string().size() + 1);
  }
  return "none";
}

TEST(OptiOdom, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  EXPECT_EQ(complaint(scratch, "type,quad,\n", "0,0,0,0,0,0\n1,0,0,0,0,0\n"),
            "1_metadata.csv: the robot's type is \"quad\", expected diff, tricyc or omni3");
  EXPECT_EQ(complaint(scratch, "type,diff\nngear,x\n", "0,0,0,0,0,0\n1,0,0,0,0,0\n"),
            "1_metadata.csv: ngear is \"x\", expected a positive number, from 0.001 to 1e9");
  EXPECT_EQ(complaint(scratch, "type,diff\nngear,1\nencRes,1e-320\n", "0,0,0,0,0,0\n1,0,0,0,0,0\n"),
            "1_metadata.csv: encRes is \"1e-320\", expected a positive number, from 0.001 to 1e9");
  EXPECT_EQ(complaint(scratch, kMetadata, "0,0,0,0,0,0\n1,0,0,zero,0,0\n"),
            "1_run-01.csv:2: \"zero\", expected a finite number");
  EXPECT_EQ(complaint(scratch, kMetadata, "0,0,0,0,0,0\n1,0,0,0,0\n"),
            "1_run-01.csv:2: 5 numbers, expected 6");
  EXPECT_EQ(complaint(scratch, kMetadata, "1,0,0,0,0,0\n0,0,0,0,0,0\n"),
            "1_run-01.csv:2: time runs backwards, expected rows in order of time");
}

/// The distance from start to end by the wheels is that of the motion capture, to 2 %.
TEST(OptiOdom, WheelsAndTruthAgreeOnHowFarItWent) {
  TRUSSMAP_NEEDS_SHARED("data/optiodom");
  const Dataset read = read_optiodom(
      testing::shared("data/optiodom/diff/circular/231220200121/231220200121_run-01.csv.xz"));
  ASSERT_EQ(read.recording.drive.rows(), 2074U);
  double wheels = 0.0;
  for (std::size_t row = 0; row < 2074; ++row) {
    wheels += 0.5 * (read.recording.drive.left[row] + read.recording.drive.right[row]);
  }
  // Truth over half seconds: its noise would lengthen a sum over single rows.
  double truth = 0.0;
  for (std::size_t row = 10; row < 2074; row += 10) {
    const TruthRow& a = read.recording.truth[row - 10];
    const TruthRow& b = read.recording.truth[row];
    truth += std::hypot(b.x - a.x, b.y - a.y);
  }
  EXPECT_NEAR(wheels / truth, 1.0, 0.02);
}

TEST(OptiOdom, OtherDrivesBecomeColumnsThatTheModelNames) {
  const ScratchFolder scratch;
  scratch.write("8_metadata.csv", "type,tricyc,\nngear,1\nencRes,100\nLi,0.15\n");
  const Dataset tricycle =
      read_optiodom(scratch.write("8_run-01.csv", "0,0,0,0,0,0.1\n0.05,0.1,0.2,0.3,10,-0.2\n"));
  EXPECT_EQ(tricycle.model.robot.drive, DriveKind::tricycle);
  ASSERT_EQ(tricycle.recording.drive.covariates.size(), 2U);
  EXPECT_TRUE(tricycle.recording.drive.left.empty());
  EXPECT_NEAR(tricycle.recording.drive.covariates[0].values[1], 0.1 * M_PI * 0.065, 1e-15);
  EXPECT_EQ(tricycle.recording.drive.covariates[1].values[1], -0.2);
  scratch.write("9_metadata.csv", "type,omni3,\nngear,12\nencRes,1024\nLi,0.195\n");
  const Dataset omni =
      read_optiodom(scratch.write("9_run-01.csv", "0,0,0,0,0,0,0\n0.05,0.1,0.2,0.3,1,2,-3\n"));
  EXPECT_EQ(omni.model.robot.drive, DriveKind::omni3);
  ASSERT_EQ(omni.recording.drive.covariates.size(), 3U);
  EXPECT_NEAR(omni.recording.drive.covariates[2].values[1], -3.0 * M_PI * 0.102 / 12288.0, 1e-15);
}

/// All runs of a robot's sets, ready for its drive.
std::vector<DrivenRecording> runs_of(const std::string& robot,
                                     const std::vector<std::string>& sets) {
  std::vector<DrivenRecording> runs;
  for (const std::string& set : sets) {
    const std::string name = set.substr(set.find('/') + 1);
    for (const char* const run : {"_run-01.csv", "_run-02.csv", "_run-03.csv", "_run-04.csv"}) {
      const auto file = testing::shared("data/optiodom/" + robot) / set / (name + run);
      const bool packed = !std::filesystem::exists(file);
      const std::filesystem::path there = packed ? file.string() + ".xz" : file.string();
      if (!std::filesystem::exists(there)) continue;
      const Dataset one = read_optiodom(there);
      runs.push_back(with_wheels(one.recording, one.model.robot));
    }
  }
  return runs;
}

/// Calibrated by circles, the steered robot's squares and free paths end where they should.
TEST(OptiOdom, ATricyclesOtherPathsEndThreeTimesNearer) {
  TRUSSMAP_NEEDS_SHARED("data/optiodom/tricyc");
  const std::vector<DrivenRecording> circles =
      runs_of("tricyc", {"circular/140120211415", "circular/140120211440"});
  const std::vector<DrivenRecording> others =
      runs_of("tricyc", {"free/140120211508", "square/140120211430", "square/140120211446"});
  ASSERT_EQ(circles.size(), 4U);
  ASSERT_EQ(others.size(), 5U);
  Model model;
  model.robot.drive = DriveKind::tricycle;
  model.robot.length = 0.15;
  model.robot.columns = {"wheel", "steer"};
  model.noise.left = model.noise.right = 0.002;
  model.noise.truth = 0.001;
  const WheelCalibration found = calibrate_wheels(circles, model);
  ASSERT_EQ(found.constants.size(), 3U);
  // 830 mm and 98 mm when this was written.
  EXPECT_LT(rms_end(drive_errors(others, found.model, found.truth)),
            rms_end(drive_errors(others, model)) / 3.0);
}

/// Calibrated by four circles, the run by joystick ends three times nearer to where it should.
TEST(OptiOdom, TheOmnidirectionalRobotsOtherPathEndsThreeTimesNearer) {
  TRUSSMAP_NEEDS_SHARED("data/optiodom/omni3");
  const std::vector<DrivenRecording> circles = runs_of("omni3", {"circular/221220201643"});
  const std::vector<DrivenRecording> others = runs_of("omni3", {"joystick/211220201842"});
  ASSERT_EQ(circles.size(), 4U);
  ASSERT_EQ(others.size(), 1U);
  const auto file =
      testing::shared("data/optiodom/omni3/circular/221220201643") / "221220201643_run-01.csv.xz";
  const Model model = read_optiodom(file).model;
  const WheelCalibration found = calibrate_wheels(circles, model);
  EXPECT_EQ(found.constants.size(), 6U);
  // 81 mm and 16 mm when this was written.
  EXPECT_LT(rms_end(drive_errors(others, found.model, found.truth)),
            rms_end(drive_errors(others, model)) / 3.0);
}

}  // namespace
}  // namespace trussmap::optiodom_test
