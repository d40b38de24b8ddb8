// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// A tracker that is turned against the robot, told from a robot that slips and from its compass.
#include "criticism/candidates.hpp"
#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "estimation/kinds/kinds.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace trussmap::truth_heading_test {
using namespace estimation;
using namespace criticism;
namespace {

/// A drive with truth once a second, its headings turned.
DrivenRecording tracked(double turned, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, {}, seed);
  DrivenRecording recording = testing::driven(drive.recording);
  recording.survey.clear();
  std::normal_distribution<double> normal;
  const Noise noise;
  for (std::size_t row = 9; row < drive.motion.rows.size(); row += 10) {
    const TrueRow& one = drive.motion.rows[row];
    recording.truth.push_back(
        {one.t, one.pose.x + noise.truth * normal(random),
         one.pose.y + noise.truth * normal(random),
         wrap_angle(one.pose.heading + turned + noise.truth_heading * normal(random))});
  }
  return recording;
}

TEST(TruthHeading, IsNamedAsSuch) {
  const DrivenRecording recording = tracked(0.02, 5);
  const Diagnosis result = diagnose({recording}, Model());
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  EXPECT_EQ(result.missing, "truth heading");
  const Finding& first = result.findings.front();
  EXPECT_NEAR(first.effect.coefficients[0], 0.02, 4.0 * first.sd[0]);
  EXPECT_LT(first.sd[0], 0.002);
}

// What it adds to truth rows, by differences of the fit's own residuals.
TEST(TruthHeading, MovesTruthRowsAlone) {
  const DrivenRecording recording = tracked(0.0, 6);
  const ModelFit fit = fit_model({recording}, Model());
  Effect effect{"truth heading", Channel::truth_heading, {"1"}, {}};
  const ScoreTest tests(*fit.state);
  const Eigen::MatrixXd column = tests.columns(effect);
  ASSERT_EQ(column.cols(), 1);
  const RecordingProblem& problem = fit.state->problem;
  Eigen::Index at = 0;
  int truths = 0;
  for (const Measurement& one : problem.measurements) {
    Vector4 wanted = Vector4::Zero();
    // predicted - measured; measured = heading + g.
    if (one.kind == &kinds::truth) {
      ++truths;
      wanted = one.whitener.col(2);
    }
    for (Eigen::Index row = 0; row < one.rows; ++row, ++at) {
      EXPECT_NEAR(column(at, 0), wanted[row], 1e-9);
    }
  }
  EXPECT_GT(truths, 20);
}

TEST(TruthHeading, IsNoCandidateWithoutTruth) {
  DrivenRecording recording = tracked(0.0, 7);
  recording.truth.clear();
  const ModelFit fit = fit_model({recording}, Model());
  const ScoreTest tests(*fit.state);
  for (const Candidate& one : candidates_for(*fit.state, tests.context())) {
    EXPECT_NE(one.effect.channel, Channel::truth_heading) << one.effect.name;
  }
}

}  // namespace
}  // namespace trussmap::truth_heading_test
