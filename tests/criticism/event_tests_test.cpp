// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tests of single events against dense algebra, against refits, and against drives in which
// something is known to have happened.
#include "criticism/event_tests.hpp"

#include "criticism/known_events.hpp"
#include "driven.hpp"
#include "estimation/data_snooping.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::event_tests_test {
using namespace fitting;
using namespace criticism;
namespace {

using testing::Bump;
using testing::bumped;
using testing::Moved;
using testing::moved_by;
using testing::NoisyDrive;
using testing::NoisyWorld;
using testing::simulate_world;
using testing::with_another;
using testing::with_moved_landmark;

std::vector<TestedEvent> events_of(const NoisyDrive& world) {
  const FitState fit = fit_recordings(world.recordings, world.model);
  return test_events(fit, ScoreTest(fit));
}

TEST(EventTests, TheScoreIsWhatTheProjectedColumnsExplain) {
  const Bump one = bumped({true, true, false, 1}, 9.0, 3);
  const FitState fit = fit_recordings(one.world.recordings, one.world.model);
  const ScoreTest tests(fit);
  int kept = 0;
  for (const TestedEvent& event : test_events(fit, tests)) {
    if (event.p_adjusted >= 0.05) {
      EXPECT_EQ(event.projected.cols(), 0);
      continue;
    }
    ++kept;
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(event.projected);
    const double explained = (event.projected * factor.solve(tests.residuals())).squaredNorm();
    EXPECT_NEAR(event.score, explained, 1e-3 * explained) << event.name;
    // The two differ in the state that they are taken at, by the noise of the fit.
    EXPECT_LE((tests.projected(event.projected) - event.projected).norm(),
              1e-2 * event.projected.norm());
  }
  EXPECT_GT(kept, 0);
}

TEST(EventTests, AWrongSightingHasTheStatisticOfDataSnooping) {
  const NoisyDrive world = simulate_world({true, false, true, 1}, 8);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const std::vector<estimation::CheckedMeasurement> checked =
      estimation::snoop(fit.problem, fit.columns.border, fit.adjustment);
  int compared = 0;
  for (const TestedEvent& event : test_events(fit, ScoreTest(fit))) {
    if (event.kind != EventKind::sighting) continue;
    const estimation::CheckedMeasurement& same = checked[event.measurements.front()];
    // To what a fit's settled residuals leave of their gradient.
    EXPECT_NEAR(event.score, same.statistic, 1e-3 * (1.0 + same.statistic)) << event.name;
    EXPECT_EQ(event.dof, same.checked);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(EventTests, AMovedLandmarkIsWorthTwoLandmarks) {
  std::string landmark;
  const NoisyDrive world = with_moved_landmark(12.0, 5, landmark);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const TestedEvent found = test_events(fit, ScoreTest(fit)).front();
  EXPECT_EQ(found.kind, EventKind::landmark);
  EXPECT_EQ(found.name, landmark);
  const Moved moved = moved_by(world, landmark);
  const double fallen = fit.adjustment.chi2 - moved.chi2;
  EXPECT_NEAR(found.score, fallen, 0.02 * fallen);
  EXPECT_EQ(found.change, EventChange::moved);
  EXPECT_EQ(found.when.session, "run 1");
  EXPECT_EQ(found.when.next_session, "run 2");
  const Vector2 by(found.size.at(0), found.size.at(1));
  EXPECT_LT((by - moved.by).norm(), 0.1 * moved.by.norm());
}

TEST(EventTests, AWrongSurveyPointIsTheLandmarksOwn) {
  NoisyDrive world = simulate_world({}, 9);
  SurveyPoint& wrong = world.recordings.front().survey[5];
  wrong.x += 0.1;
  const FitState fit = fit_recordings(world.recordings, world.model);
  const TestedEvent found = test_events(fit, ScoreTest(fit)).front();
  EXPECT_EQ(found.kind, EventKind::landmark);
  EXPECT_EQ(found.name, wrong.landmark);
  EXPECT_EQ(found.change, EventChange::survey_off);
  world.recordings.front().survey.erase(world.recordings.front().survey.begin() + 5);
  const double fallen =
      fit.adjustment.chi2 - fit_recordings(world.recordings, world.model).adjustment.chi2;
  EXPECT_NEAR(found.score, fallen, 0.02 * fallen);
}

TEST(EventTests, ALandmarkThatMovesDuringASessionIsFound) {
  NoisyDrive world = simulate_world({true, false, true, 2}, 2);
  // From the middle on it is seen, and stood on, as another: merge two that lie 3 m apart.
  const double half = 0.5 * world.recordings.front().drive.t.back();
  for (Sighting& sighting : world.recordings.front().sightings) {
    if (sighting.landmark == "L1_2" && !sighting.standing() && sighting.t > half) {
      sighting.range += 0.3;
    }
  }
  const std::vector<TestedEvent> found = events_of(world);
  EXPECT_EQ(found.front().kind, EventKind::landmark);
  EXPECT_EQ(found.front().name, "L1_2");
}

TEST(EventTests, ASessionWithAnotherScaleIsOutOfLine) {
  NoisyDrive world = simulate_world({true, true, false, 1, 3}, 6);
  MotionRows& drive = world.recordings[1].drive;
  for (double& left : drive.pair.left) left *= 1.01;
  for (double& right : drive.pair.right) right *= 1.01;
  testing::retake(drive);
  const std::vector<TestedEvent> found = events_of(world);
  EXPECT_EQ(found.front().kind, EventKind::session);
  EXPECT_EQ(found.front().name, "run 2");
  EXPECT_LT(found.front().p_adjusted, 1e-3);
}

/// Travel, turn, compass, delay: a robot without a compass has none of the third.
TEST(EventTests, ASessionsSizesHaveTheirPlaces) {
  for (const bool compass : {true, false}) {
    NoisyDrive world = simulate_world({compass, true, false, 1, 3}, 6);
    MotionRows& drive = world.recordings[1].drive;
    for (double& left : drive.pair.left) left *= 1.02;
    for (double& right : drive.pair.right) right *= 1.02;
    testing::retake(drive);
    const std::vector<TestedEvent> found = events_of(world);
    ASSERT_EQ(found.front().kind, EventKind::session);
    ASSERT_EQ(found.front().size.size(), 4U);
    EXPECT_NEAR(found.front().size[0], -0.02, 0.01);
    EXPECT_EQ(std::isnan(found.front().size[2]), !compass);
    EXPECT_TRUE(std::isfinite(found.front().size[3]));
  }
}

TEST(EventTests, WhatItIsConditionedOnIsNotFoundAgain) {
  const Bump one = bumped({true, true, false, 1}, 9.0, 4);
  const FitState fit = fit_recordings(one.world.recordings, one.world.model);
  const ScoreTest tests(fit);
  const TestedEvent first = test_events(fit, tests).front();
  ASSERT_EQ(first.name, one.name);
  for (const TestedEvent& event : test_events(fit, tests, first.projected)) {
    EXPECT_GT(event.p_adjusted, 0.05) << event.name;
  }
}

TEST(SlowEventTests, ABumpOfFiveStandardDeviationsIsFirst) {
  constexpr int kSeeds = 25;
  int first = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Bump one = bumped({}, 5.0, seed);
    const TestedEvent found = events_of(one.world).front();
    first += found.kind == EventKind::leg && found.name == one.name ? 1 : 0;
  }
  EXPECT_GE(first, 0.76 * kSeeds);  // of 200, 180 are: 0.9 less 2.3 sds of a count
}

TEST(SlowEventTests, ALandmarkMovedByFiveStandardDeviationsIsFirst) {
  constexpr int kSeeds = 25;
  int first = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    std::string landmark;
    const TestedEvent found = events_of(with_moved_landmark(5.0, seed, landmark)).front();
    first += found.kind == EventKind::landmark && found.name == landmark ? 1 : 0;
  }
  EXPECT_GE(first, 0.76 * kSeeds);  // of 200, 182 are: 0.91 less 2.6 sds of a count
}

TEST(SlowEventTests, WhereNothingHappenedNothingIsNamed) {
  constexpr int kSeeds = 50;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    named += events_of(simulate_world({true, true, false, 1, 2}, seed)).front().p_adjusted < 0.05;
  }
  // 5 % and 3 sds of a count.
  EXPECT_LE(named, 0.05 * kSeeds + 3.0 * std::sqrt(0.05 * 0.95 * kSeeds));
}

}  // namespace
}  // namespace trussmap::event_tests_test
