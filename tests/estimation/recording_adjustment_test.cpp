// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_adjustment.hpp"

#include "driven.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/recording_system.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::recording_adjustment_test {
using namespace estimation;
namespace {

using testing::Equipment;
using testing::largest_error;
using testing::simulate_exactly;
using testing::simulate_recording;
using testing::SimulatedRecording;

std::string refusal(const RecordingProblem& problem) {
  try {
    static_cast<void>(adjust(problem));
  } catch (const SolveError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RecordingAdjustment, ExactRecordingsGiveTheExactMap) {
  for (const Equipment& equipment :
       {Equipment{true, true, false}, Equipment{true, false, false}, Equipment{false, true, false},
        Equipment{false, false, false}, Equipment{false, false, true}}) {
    const SimulatedRecording one = simulate_exactly(equipment, 11);
    const RecordingProblem problem = make_problem({one.recording}, one.model);
    const RecordingAdjustment fit = adjust(problem);
    EXPECT_LT(largest_error(problem, fit.state, one.truth), 1e-6);
    EXPECT_LT(fit.chi2, 1e-6);
    EXPECT_TRUE(fit.converged);
    EXPECT_TRUE(fit.left_out.empty());
  }
}

/// Soft weights lead to the start of an adjustment with a gate; what stays in counts in full.
TEST(RecordingAdjustment, AGateThatLeavesNothingOutChangesNothing) {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const SimulatedRecording one = simulate_recording({true, true, false}, seed);
    const RecordingProblem problem = make_problem({one.recording}, one.model);
    const RecordingAdjustment plain = adjust(problem);
    RecordingAdjustmentOptions options;
    options.gate = 400.0;  // twenty standard deviations
    const RecordingAdjustment gated = adjust(problem, {}, options);
    EXPECT_TRUE(gated.left_out.empty());
    EXPECT_GT(plain.chi2, 1.0);
    EXPECT_NEAR(gated.chi2, plain.chi2, 1e-6 * plain.chi2);
    EXPECT_EQ(gated.dof, plain.dof);
  }
}

TEST(RecordingAdjustment, PosesStandAtSightingsAndBetweenSpinAndDrive) {
  const SimulatedRecording one = simulate_exactly({true, true, false, 1}, 11);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  const std::size_t sightings = one.recording.sightings.size();
  EXPECT_GT(problem.poses.size(), sightings);
  EXPECT_LE(problem.poses.size(), 4 * sightings);  // corners have two changes of their own
  for (std::size_t k = 1; k < problem.poses.size(); ++k) {
    EXPECT_LT(problem.poses[k - 1].t, problem.poses[k].t);
  }
  // All rows between first and last sighting are in exactly one segment.
  double rows = 0.0;
  for (const auto& segment : problem.segments) {
    for (const SegmentRow& row : segment) rows += row.part;
  }
  EXPECT_NEAR(rows, static_cast<double>(one.recording.drive.rows()), 1e-9);
}

TEST(RecordingAdjustment, TheGradientVanishesAndNoNeighbourIsBetter) {
  const SimulatedRecording one = simulate_recording({false, false, true}, 4);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  const RecordingAdjustment fit = adjust(problem);
  const EffectParameters none;
  RecordingSystem system(problem, none);
  for (int axis = 0; axis < 2; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      RecordingState beside = fit.state;
      beside.landmarks[5][axis] += step;
      EXPECT_GT(system.linearise(beside, Eigen::VectorXd()), fit.chi2);
    }
  }
}

TEST(RecordingAdjustment, SessionsShareTheirLandmarks) {
  for (const bool compass : {true, false}) {
    const SimulatedRecording first = simulate_exactly({compass, false, false, 1}, 21);
    SimulatedRecording second = simulate_exactly({compass, false, false, 1}, 22);
    const RecordingProblem problem = make_problem({first.recording, second.recording}, first.model);
    EXPECT_EQ(problem.landmark_count(), 9);
    const RecordingAdjustment fit = adjust(problem);
    EXPECT_LT(largest_error(problem, fit.state, first.truth), 1e-6);
    // Without a compass neither session knows which way the other set out.
    EXPECT_EQ(fit.dof, adjust(make_problem({first.recording}, first.model)).dof +
                           adjust(make_problem({second.recording}, second.model)).dof +
                           (compass ? 16 : 15));
  }
}

TEST(RecordingAdjustment, SessionsWithNothingInCommonAreNamed) {
  const SimulatedRecording first = simulate_exactly({true, false, false, 1}, 21);
  SimulatedRecording second = simulate_exactly({true, false, false, 1}, 22);
  second.recording.name = "the other day";
  for (Sighting& sighting : second.recording.sightings) sighting.landmark += "x";
  const std::string said = refusal(make_problem({first.recording, second.recording}, first.model));
  EXPECT_EQ(said, "the other day stands apart: no landmark ties it to simulation");
}

TEST(RecordingAdjustment, ALandmarkOfWhichOnlyOneRangeIsKnownIsNamed) {
  SimulatedRecording one = simulate_exactly({true, false, false, 1}, 21);
  one.recording.sightings.push_back({one.recording.sightings.back().t, "tower", 3.0, kAbsent});
  const std::string said = refusal(make_problem({one.recording}, one.model));
  EXPECT_EQ(said.rfind("landmark tower can still move", 0), 0U) << said;
}

TEST(RecordingAdjustment, TruthRowsAreMeasurementsToo) {
  // The robot's true poses, every row's, and no landmark at all.
  const Mesh mesh = even_mesh({3, 3}, 4.0);
  std::mt19937_64 random = random_stream(3, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 1, random);
  WheeledRobot robot;
  robot.compass = false;
  const SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, robot, 3);
  DrivenRecording recording = testing::driven(drive.recording);
  recording.sightings.clear();
  recording.survey.clear();
  Model model;
  std::normal_distribution<double> normal;
  for (const TrueRow& row : drive.motion.rows) {
    recording.truth.push_back({row.t, row.pose.x + model.noise.truth * normal(random),
                               row.pose.y + model.noise.truth * normal(random),
                               row.pose.heading + model.noise.truth_heading * normal(random)});
  }
  const RecordingProblem problem = make_problem({recording}, model);
  const RecordingAdjustment fit = adjust(problem);
  EXPECT_TRUE(fit.converged);
  EXPECT_GT(fit.dof, 200);
  // chi^2 has the sd sqrt(2 dof).
  EXPECT_NEAR(fit.chi2, fit.dof, 4.0 * std::sqrt(2.0 * fit.dof));
}

TEST(RecordingAdjustment, CopiesOfASurveyCountOnce) {
  const SimulatedRecording one = simulate_exactly({true, true, false, 1}, 21);
  const RecordingProblem problem = make_problem({one.recording, one.recording}, one.model);
  EXPECT_EQ(std::count_if(problem.measurements.begin(), problem.measurements.end(),
                          [](const Measurement& m) { return m.kind == &kinds::survey; }),
            9);
}

TEST(RecordingAdjustment, JointCovarianceHoldsTheMarginalOnes) {
  const SimulatedRecording one = simulate_recording({false, false, false}, 4);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  const RecordingAdjustment fit = adjust(problem);
  const Eigen::MatrixXd joint = joint_covariance(problem, {}, fit, {5, problem.pose_node(7), 2});
  ASSERT_EQ(joint.rows(), 7);
  EXPECT_LT((joint.topLeftCorner<2, 2>() - fit.landmark_covariances[5]).norm(), 1e-12);
  EXPECT_LT((joint.bottomRightCorner<2, 2>() - fit.landmark_covariances[2]).norm(), 1e-12);
  EXPECT_GT(joint.determinant(), 0.0);
  EXPECT_EQ(fit.landmark_covariances[0].norm(), 0.0);  // the origin
}

TEST(RecordingAdjustment, DriftingHeadingsDoNotSpoilTheStart) {
  // Ten tours without a compass, wheels ten times as bad as usual: the dead-reckoned heading is
  // off by radians long before the end, a descent from there ends in nonsense.
  const Mesh mesh = even_mesh({4, 4}, 4.0);
  std::mt19937_64 random = random_stream(5, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 10, random);
  WheeledRobot robot;
  robot.compass = false;
  robot.noise.left = robot.noise.right = 0.02;
  const SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, robot, 5);
  DrivenRecording recording = testing::driven(drive.recording);
  recording.survey.clear();
  Model model;
  model.noise.left = model.noise.right = 0.02;
  const RecordingProblem problem = make_problem({recording}, model);
  const RecordingState reckoned = dead_reckoned(problem);
  double worst = 0.0;
  for (std::size_t k = 0; k < drive.motion.stops.size(); ++k) {
    const auto pose =
        std::find_if(problem.poses.begin(), problem.poses.end(),
                     [&](const PoseNode& p) { return p.t == drive.motion.stops[k].t; });
    const double heading = reckoned.poses[idx(pose - problem.poses.begin())].heading;
    worst = std::max(worst, std::abs(heading - drive.motion.stops[k].pose.heading));
  }
  EXPECT_GT(worst, 1.0);
  const RecordingAdjustment fit = adjust(problem);
  EXPECT_NEAR(fit.chi2 / fit.dof, 1.0, 4.0 * std::sqrt(2.0 / fit.dof));
}

}  // namespace
}  // namespace trussmap::recording_adjustment_test
