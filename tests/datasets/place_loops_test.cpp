// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Places that look alike: the file, and the path of a robot that a quarter of them mislead.
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::place_loops_test {
using namespace datasets;
namespace {

using testing::ScratchFolder;

TEST(PlaceLoops, BecomeARecording) {
  const ScratchFolder scratch;
  scratch.write("a_Input.txt",
                "odom2 1 0.5 0.01 0.2 1 1 1   \nodom2 1.5 1 0 0 1 1 1\nodom2 2 0 0 0 1 1 1\n"
                "loop 1.9 1.2 0.5\nloop 3 1.2 1\n");
  EXPECT_TRUE(is_place_loops(scratch.path() / "a"));
  EXPECT_FALSE(is_place_loops(scratch.path() / "b"));
  const Dataset read = read_place_loops(scratch.path() / "a");
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 2U);
  EXPECT_EQ(drive.t[0], 1.5);
  EXPECT_NEAR(0.5 * (drive.left[0] + drive.right[0]), 0.25, 1e-12);
  EXPECT_NEAR((drive.right[0] - drive.left[0]) / read.model.robot.wheelbase, 0.1, 1e-12);
  ASSERT_EQ(read.recording.loops.size(), 1U);
  EXPECT_EQ(read.recording.loops[0].t2, 1.2);
  EXPECT_EQ(read.figure("outside_drive"), 1);
}

TEST(PlaceLoops, BadFilesAreRefused) {
  const ScratchFolder scratch;
  const std::string drive = "odom2 1 0 0 0 1 1 1\nodom2 2 0 0 0 1 1 1\nodom2 3 0 0 0 1 1 1\n";
  const auto refused = [&](const std::string& text) {
    scratch.write("a_Input.txt", text);
    EXPECT_THROW(static_cast<void>(read_place_loops(scratch.path() / "a")), InputError) << text;
  };
  refused("");
  refused(drive);
  refused(drive + "loop 1 2\n");
  refused(drive + "loop 1 two 1\n");
  refused(drive + "loop 2 2 1\n");
  refused(drive + "odom2 3 0 0 0 1 1 1\nloop 1 2 1\n");
  refused(drive + "gps 1 2 1\n");
  refused("odom2 1 0 0\n");
}

/// Root mean square distance from the truth after the best rotation and translation, m.
double error_of(const std::vector<TimedPose>& poses, const std::vector<TruthRow>& truth) {
  std::vector<Vector2> here, there;
  std::size_t at = 0;
  for (const TruthRow& row : truth) {
    while (at + 1 < poses.size() && poses[at].t < row.t) ++at;
    here.push_back(poses[at].estimate.pose.position());
    there.emplace_back(row.x, row.y);
  }
  return align_rigidly(here, there).rms;
}

/// Of 5180 loops half are more than 1.9 m from where they say, a quarter more than 4.1 m.
TEST(SlowPlaceLoops, LeadARobotThroughALectureHall) {
  TRUSSMAP_NEEDS_SHARED("data/tuc-slam");
  const Dataset read = read_place_loops(testing::shared("data/tuc-slam/Lecture_Hall"));
  std::vector<TruthRow> truth;
  std::istringstream text(read_file(testing::shared("data/tuc-slam/Lecture_Hall_GT.txt.xz")));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string tag;
    TruthRow row;
    if (words >> tag >> row.t >> row.x >> row.y && tag == "point2") truth.push_back(row);
  }
  ASSERT_GT(truth.size(), 6000U);
  const ModelFit fit =
      fit_model({read.recording}, read.model, {.gate = 16.0, .most_left_out = 0.12});
  const double reckoned = error_of(dead_reckoned_poses(read.recording, read.model), truth);
  EXPECT_GT(fit.left_out.size(), 500U);
  EXPECT_LT(error_of(adjusted_poses(fit), truth), reckoned / 5.0);
}

}  // namespace
}  // namespace trussmap::place_loops_test
