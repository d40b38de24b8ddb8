// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tests of single events against dense algebra, against refits, and against drives in which
// something is known to have happened.
#include "criticism/event_tests.hpp"

#include "criticism/known_events.hpp"
#include "estimation/data_snooping.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap {
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

std::vector<EventTest> events_of(const NoisyDrive& world) {
  const ModelFit fit = fit_model(world.recordings, world.model);
  return test_events(fit, ScoreTest(fit));
}

TEST(EventTests, TheScoreIsWhatTheProjectedColumnsExplain) {
  const Bump one = bumped({true, true, false, 1}, 9.0, 3);
  const ModelFit fit = fit_model(one.world.recordings, one.world.model);
  const ScoreTest tests(fit);
  int kept = 0;
  for (const EventTest& event : test_events(fit, tests)) {
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
  const ModelFit fit = fit_model(world.recordings, world.model);
  const std::vector<CheckedMeasurement> checked =
      snoop(fit.problem, fit.columns.border, fit.adjustment);
  int compared = 0;
  for (const EventTest& event : test_events(fit, ScoreTest(fit))) {
    if (event.kind != "sighting") continue;
    const CheckedMeasurement& same = checked[event.measurements.front()];
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
  const ModelFit fit = fit_model(world.recordings, world.model);
  const EventTest found = test_events(fit, ScoreTest(fit)).front();
  EXPECT_EQ(found.kind, "landmark");
  EXPECT_EQ(found.name, landmark);
  const Moved moved = moved_by(world, landmark);
  const double fallen = fit.adjustment.chi2 - moved.chi2;
  EXPECT_NEAR(found.score, fallen, 0.02 * fallen);
  EXPECT_NE(found.in_words.find("between run 1 and run 2"), std::string::npos) << found.in_words;
}

TEST(EventTests, AWrongSurveyPointIsTheLandmarksOwn) {
  NoisyDrive world = simulate_world({}, 9);
  SurveyPoint& wrong = world.recordings.front().survey[5];
  wrong.x += 0.1;
  const ModelFit fit = fit_model(world.recordings, world.model);
  const EventTest found = test_events(fit, ScoreTest(fit)).front();
  EXPECT_EQ(found.kind, "landmark");
  EXPECT_EQ(found.name, wrong.landmark);
  EXPECT_NE(found.in_words.find("survey"), std::string::npos) << found.in_words;
  world.recordings.front().survey.erase(world.recordings.front().survey.begin() + 5);
  const double fallen =
      fit.adjustment.chi2 - fit_model(world.recordings, world.model).adjustment.chi2;
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
  const std::vector<EventTest> found = events_of(world);
  EXPECT_EQ(found.front().kind, "landmark");
  EXPECT_EQ(found.front().name, "L1_2");
}

TEST(EventTests, ASessionWithAnotherScaleIsOutOfLine) {
  NoisyDrive world = simulate_world({true, true, false, 1, 3}, 6);
  Drive& drive = world.recordings[1].drive;
  for (double& left : drive.left) left *= 1.01;
  for (double& right : drive.right) right *= 1.01;
  const std::vector<EventTest> found = events_of(world);
  EXPECT_EQ(found.front().kind, "session");
  EXPECT_EQ(found.front().name, "run 2");
  EXPECT_LT(found.front().p_adjusted, 1e-3);
}

TEST(EventTests, WhatIsTakenOutIsNotFoundAgain) {
  const Bump one = bumped({true, true, false, 1}, 9.0, 4);
  const ModelFit fit = fit_model(one.world.recordings, one.world.model);
  const ScoreTest tests(fit);
  const EventTest first = test_events(fit, tests).front();
  ASSERT_EQ(first.name, one.name);
  for (const EventTest& event : test_events(fit, tests, first.projected)) {
    EXPECT_GT(event.p_adjusted, 0.05) << event.name;
  }
}

TEST(SlowEventTests, ABumpOfFiveStandardDeviationsIsFirst) {
  constexpr int kSeeds = 25;
  int first = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Bump one = bumped({}, 5.0, seed);
    const EventTest found = events_of(one.world).front();
    first += found.kind == "leg" && found.name == one.name ? 1 : 0;
  }
  EXPECT_GE(first, 0.76 * kSeeds);  // of 200, 180 are: 0.9 less 2.3 sds of a count
}

TEST(SlowEventTests, ALandmarkMovedByFiveStandardDeviationsIsFirst) {
  constexpr int kSeeds = 25;
  int first = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    std::string landmark;
    const EventTest found = events_of(with_moved_landmark(5.0, seed, landmark)).front();
    first += found.kind == "landmark" && found.name == landmark ? 1 : 0;
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
}  // namespace trussmap
