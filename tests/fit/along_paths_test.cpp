// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks that a fit has no place for: a delay took all their sightings out of the drive, and a
// later round takes them back.
#include "fit/along_paths.hpp"

#include "trussmap/dead_reckoning.hpp"
#include "trussmap/robot.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace trussmap::along_paths_test {
namespace {

/// Straight ahead along x for ten rows of a metre.
Recording straight() {
  Recording recording;
  for (int k = 1; k <= 10; ++k) {
    recording.drive.t.push_back(k);
    recording.drive.left.push_back(1.0);
    recording.drive.right.push_back(1.0);
  }
  return recording;
}

TEST(AlongPaths, ALandmarkWithoutAPlaceLiesWhereItIsSeen) {
  Recording recording = straight();
  // Twice from x = 2 and 4, 3 m away to the left; once by its range alone; once stood on.
  recording.sightings = {{2.0, "seen", 3.0, 0.5 * std::numbers::pi},
                         {3.0, "known"},
                         {4.0, "seen", 3.0, 0.5 * std::numbers::pi},
                         {5.0, "ranged", 1.0, kAbsent},
                         {7.0, "stood on"}};
  const Model model;
  const std::vector<DrivenRecording> recordings =
      with_wheels(std::vector<Recording>{recording}, model.robot);
  const estimation::RecordingProblem problem = estimation::make_problem(recordings, model, {});
  const std::vector<fitting::SessionPath> paths{
      {Pose(), dead_reckoned_path(recordings[0].drive, model.robot, model.noise)}};
  const estimation::RecordingState state =
      fitting::along_paths(problem, recordings, paths, {{"known", Vector2(30.0, 40.0)}});
  ASSERT_EQ(state.landmarks.size(), 4U);
  ASSERT_EQ(state.poses.size(), problem.poses.size());
  for (int k = 0; k < problem.landmark_count(); ++k) {
    const std::string& name = problem.landmarks[static_cast<std::size_t>(k)];
    const Vector2 expected = name == "known"    ? Vector2(30.0, 40.0)
                             : name == "seen"   ? Vector2(3.0, 3.0)
                             : name == "ranged" ? Vector2(5.0, 0.0)
                                                : Vector2(7.0, 0.0);
    EXPECT_LE((state.landmarks[static_cast<std::size_t>(k)] - expected).norm(), 1e-9) << name;
  }
}

}  // namespace
}  // namespace trussmap::along_paths_test
