// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::graph_recording_test {
namespace {

using testing::ScratchFolder;

/// Ids with gaps, an edge backwards, a loop, and a point.
const std::string kGraph =
    "VERTEX_SE2 10 0 0 0\nVERTEX_SE2 12 0 0 0\nVERTEX_SE2 30 0 0 0\nVERTEX_XY 7 0 0\n"
    "EDGE_SE2 10 12 1 0.2 0.5 100 0 0 100 0 400\n"
    "EDGE_SE2 30 12 -0.8 0.3 -0.4 100 0 0 100 0 400\n"
    "EDGE_SE2 30 10 -1.5 -0.9 -0.9 25 0 0 25 0 100\n"
    "EDGE_SE2_XY 12 7 3 4 4 0 4\n";

TEST(Dataset, ReckonsAsItsEdgesSay) {
  const ScratchFolder scratch;
  const Dataset read = datasets::read_graph_recording(scratch.write("a.g2o", kGraph));
  const DrivenRecording recording = with_wheels(read.recording, read.model.robot);
  const std::vector<Pose> path =
      dead_reckoned_path(recording.drive, read.model.robot, read.model.noise);
  ASSERT_EQ(path.size(), 2U);
  const Pose first{1.0, 0.2, 0.5};
  EXPECT_NEAR((path[0].position() - first.position()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(path[0].heading, 0.5, 1e-12);
  // The next is where pose 12 lies as seen from it.
  const Pose back = compose(path[1], {-0.8, 0.3, -0.4});
  EXPECT_NEAR((back.position() - first.position()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(back.heading, 0.5, 1e-12);
  ASSERT_EQ(recording.loops.size(), 1U);
  EXPECT_EQ(recording.loops[0].t, 0.0);
  EXPECT_EQ(recording.loops[0].t2, 2.0);
  const Pose round =
      compose({recording.loops[0].dx, recording.loops[0].dy, recording.loops[0].dtheta},
              {-1.5, -0.9, -0.9});
  EXPECT_NEAR(round.position().norm() + std::abs(round.heading), 0.0, 1e-12);
  EXPECT_NEAR(recording.loops[0].sd_heading, 0.1, 1e-12);
  ASSERT_EQ(recording.sightings.size(), 1U);
  EXPECT_EQ(recording.sightings[0].landmark, "7");
  EXPECT_EQ(recording.sightings[0].t, 1.0);
  EXPECT_NEAR(recording.sightings[0].range, 5.0, 1e-12);
  EXPECT_NEAR(read.model.noise.range, 0.5, 1e-12);
  EXPECT_NEAR(read.model.noise.bearing, 0.1, 1e-12);
  EXPECT_NEAR(read.model.noise.heading_per_s, 0.05, 1e-12);
}

std::string complaint(const std::string& text) {
  const ScratchFolder scratch;
  try {
    (void)datasets::read_graph_recording(scratch.write("a.g2o", text));
  } catch (const InputError& error) {
    return std::string(error.what()).substr(scratch.path().string().size() + 1);
  }
  return "none";
}

TEST(Dataset, SaysWhatIsWrong) {
  const std::string poses = "VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 0 0 0\nVERTEX_SE2 3 0 0 0\n";
  EXPECT_EQ(complaint(poses + "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 3 1 0 0 1 0 0 1 0 1\n"),
            "a.g2o: has no edge from pose 2 to the next, 3, expected odometry between all");
  EXPECT_EQ(complaint(poses + "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\nEDGE_SE2 2 3 1 0 0 1 0 0 1 0 1\n"),
            "a.g2o: has no edges but those from pose to pose, expected loops or points");
  EXPECT_EQ(complaint(poses + "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 0\nEDGE_SE2 2 3 1 0 0 1 0 0 1 0 1\n"
                              "EDGE_SE2 1 3 1 0 0 1 0 0 1 0 1\n"),
            "a.g2o: has an edge from 1 to 2 that leaves a coordinate unknown, expected information "
            "of full rank");
  EXPECT_EQ(complaint("VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 0 0 0\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"),
            "a.g2o: has 2 poses, expected three at least");
}

/// As a recording the Intel laboratory is adjusted to where it is adjusted to as a graph.
TEST(SlowGraphRecording, IntelIsWhatTheGraphIs) {
  TRUSSMAP_NEEDS_SHARED("data/posegraph/input_INTEL_g2o.g2o.xz");
  const auto file = testing::shared("data/posegraph/input_INTEL_g2o.g2o.xz");
  const PoseGraphAdjustment graph = adjust(read_g2o(file.string()));
  const Dataset read = datasets::read_graph_recording(file);
  const ModelFit fit = fit_model({with_wheels(read.recording, read.model.robot)}, read.model);
  const std::vector<TimedPose> poses = adjusted_poses(fit, 0);
  ASSERT_EQ(poses.size(), graph.estimates.size());
  double sum = 0.0;
  const Pose& origin = graph.estimates.front();
  const Pose& start = poses.front().estimate.pose;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Vector2 there =
        rotation(-origin.heading) * (graph.estimates[k].position() - origin.position());
    const Vector2 here =
        rotation(-start.heading) * (poses[k].estimate.pose.position() - start.position());
    sum += (there - here).squaredNorm();
  }
  // Of 27 m; loops are good to 0.2 m each.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(poses.size())), 0.2);
}

}  // namespace
}  // namespace trussmap::graph_recording_test
