// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fitted_path.hpp"

#include "criticism/disturbances.hpp"
#include "drive/row_variables.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::fitted_path_test {
using namespace fitting;
namespace {

using testing::disturbed_cases;
using testing::DisturbedCase;
using testing::invert;
using testing::inverted_model;
using testing::InvertedRecording;

Vector2 place(const Pose& pose) {
  return pose.position();
}

Vector2 vector_of(const std::complex<double>& point) {
  return {point.real(), point.imag()};
}

TEST(FittedPath, IsTheTruePathOfANoiseFreeRecordingUnderItsEffect) {
  for (const DisturbedCase& one : disturbed_cases()) {
    InvertedRecording simulated = invert(one.disturbance, one.options, 41);
    // Nothing is sighted at first and at last: there the path is reckoned back and on.
    std::vector<Sighting>& sightings = simulated.recording.sightings;
    if (!one.options.views) {
      sightings.erase(sightings.begin(), sightings.begin() + 2);
      sightings.resize(sightings.size() - 2);
    }
    const FitState fit =
        fit_recordings({simulated.recording}, inverted_model({catalogue_effect(one.effect)}));
    ASSERT_EQ(fit.paths.size(), 1U);
    ASSERT_EQ(fit.paths[0].ends.size(), simulated.places.size());
    double worst = 0.0;
    double worst_heading = 0.0;
    for (std::size_t row = 0; row < simulated.places.size(); ++row) {
      const Pose& end = fit.paths[0].ends[row];
      worst = std::max(worst, (place(end) - vector_of(simulated.places[row])).norm());
      worst_heading =
          std::max(worst_heading,
                   std::abs(std::remainder(end.heading - simulated.headings[row], 2.0 * M_PI)));
    }
    EXPECT_LT(worst, 2e-6) << one.effect;
    EXPECT_LT(worst_heading, 1e-6) << one.effect;
    // It rests in its first rows.
    EXPECT_LT((place(fit.paths[0].start) - vector_of(simulated.places[0])).norm(), 2e-6);
  }
}

TEST(FittedPath, WhatIsMissingAtANodeIsNoiseOfTheWheelsThatAddsUpToIt) {
  const InvertedRecording simulated = invert({}, {1}, 42);
  const Model model = inverted_model();
  const std::vector<DrivenRecording> recordings = {simulated.recording};
  const FitState fit = fit_recordings(recordings, model);
  estimation::RecordingState state = fit.adjustment.state;
  // The end of a drive, and with it the next turn on the spot.
  constexpr std::size_t kMoved = 4;
  for (const std::size_t k : {kMoved, kMoved + 1}) {
    state.poses[k].x += 0.03;
    state.poses[k].y -= 0.01;
  }
  const SessionPath path =
      fitted_paths(recordings, model.robot, fit.problem, {}, Eigen::VectorXd(), state)[0];
  const MotionRows& drive = recordings[0].drive;
  // Brute force: every row's record and what it lacks, one after the other.
  double most = 0.0;
  double farthest = 0.0;
  Pose before = path.start;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double travel = drive.forward[row] + path.missing[row][0];
    const double turn = drive.turn[row] + path.missing[row][1];
    const double half = before.heading + 0.5 * turn;
    const double chord =
        std::abs(turn) < 1e-9 ? travel : travel * std::sin(0.5 * turn) / (0.5 * turn);
    const Vector2 reached(before.x + chord * std::cos(half), before.y + chord * std::sin(half));
    most = std::max(most, path.missing[row].cwiseAbs().maxCoeff());
    farthest = std::max(farthest, (reached - path.ends[row].position()).norm());
    before = path.ends[row];
  }
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(farthest, 1e-3);  // what turns on the spot and rests cannot take up is spread evenly
  const std::size_t at = drive::row_at(drive, fit.problem.poses[kMoved].t);
  EXPECT_NEAR(path.ends[at].x, state.poses[kMoved].x, 1e-9);
  EXPECT_NEAR(path.ends[at].y, state.poses[kMoved].y, 1e-9);
  EXPECT_NEAR(std::remainder(path.ends[at].heading - state.poses[kMoved].heading, 2.0 * M_PI), 0.0,
              1e-9);
}

TEST(FittedPath, PoseAtGoesAlongTheRow) {
  MotionRows drive;
  drive.t = {1.0, 2.0, 4.0};
  drive.forward = {1.0, 1.0, 2.0};
  drive.turn = {0.0, 0.0, 0.0};
  SessionPath path;
  path.start = {0.0, 0.0, 3.0};
  path.ends = {{1.0, 0.0, 3.2}, {1.0, 2.0, -3.0}, {5.0, 2.0, -2.0}};
  // -3 is 0.083 rad beyond 3.2: across the cut, not all the way round.
  const Pose half = pose_at(drive, path, 1.5);
  EXPECT_DOUBLE_EQ(half.x, 1.0);
  EXPECT_DOUBLE_EQ(half.y, 1.0);
  EXPECT_NEAR(half.heading, 3.2 + 0.5 * (2.0 * M_PI - 6.2), 1e-12);
  EXPECT_DOUBLE_EQ(pose_at(drive, path, 0.25).x, 0.25);  // the first row begins at 0
  EXPECT_DOUBLE_EQ(pose_at(drive, path, 3.0).x, 3.0);
  EXPECT_DOUBLE_EQ(pose_at(drive, path, 4.0).x, 5.0);
  EXPECT_DOUBLE_EQ(pose_at(drive, path, 9.0).x, 5.0);
  EXPECT_DOUBLE_EQ(pose_at(drive, path, -9.0).x, 0.0);
}

}  // namespace
}  // namespace trussmap::fitted_path_test
