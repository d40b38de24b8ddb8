// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tests of single events against dense algebra, against refits, and against drives in which
// something is known to have happened.
#include "trussmap/criticism/event_tests.hpp"

#include "trussmap/adjustment/data_snooping.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "criticism/noisy_recordings.hpp"

namespace trussmap {
namespace {

using testing::NoisyDrive;
using testing::NoisyWorld;
using testing::simulate_world;

struct Bump {
  NoisyDrive world;
  std::string name;  ///< of the leg
};

/// In one row of one leg, one wheel says too much: so many of the standard deviations with which
/// all the rest determines it.
Bump bumped(const NoisyWorld& how, double sds, std::uint64_t seed) {
  Bump result{simulate_world(how, seed), {}};
  std::mt19937_64 random(seed + 77);
  const TrueMotion& motion = result.world.motions.front();
  Drive& drive = result.world.recordings.front().drive;
  const std::size_t leg = 1 + random() % (motion.stops.size() - 1);
  std::size_t row = 0;
  do {
    row = motion.stops[leg - 1].rows +
          random() % (motion.stops[leg].rows - motion.stops[leg - 1].rows);
  } while (motion.rows[row].activity != Activity::drive);
  const bool left = random() % 2 == 0;
  const double sign = random() % 2 == 0 ? 1.0 : -1.0;
  const ModelFit fit = fit_model(result.world.recordings, result.world.model);
  const ScoreTest tests(fit);
  EffectPattern pattern;
  pattern.drives.emplace_back(drive.rows());
  pattern.drives[0][row].advance = 0.5;
  pattern.drives[0][row].turn = (left ? -1.0 : 1.0) / result.world.model.robot.wheelbase;
  const EffectBorder border{pattern};
  RecordingSystem system(fit.problem, border);
  system.linearise(fit.adjustment.state, Eigen::VectorXd::Zero(1));
  const double told = tests.projected(system.border()).norm();
  (left ? drive.left : drive.right)[row] += sign * sds / told;
  const auto name = [&](std::size_t stop) {
    return landmark_name(result.world.mesh, motion.stops[stop].landmark);
  };
  char time[40];
  std::snprintf(time, sizeof time, " at t = %.1f s", motion.stops[leg].t);
  result.name = name(leg - 1) + " -> " + name(leg) + time;
  return result;
}

/// Sightings of a landmark in the last session, under another name.
std::vector<Recording> with_another(std::vector<Recording> recordings,
                                    const std::string& landmark) {
  for (Sighting& sighting : recordings.back().sightings) {
    if (sighting.landmark == landmark) sighting.landmark += "'";
  }
  return recordings;
}

/// Where it was in the last session, less where it was before, and the covariance of that.
struct Moved {
  Vector2 by;
  Matrix2 covariance;
  double chi2 = 0.0;
};
Moved moved_by(const NoisyDrive& world, const std::string& landmark) {
  const ModelFit fit = fit_model(with_another(world.recordings, landmark), world.model);
  int before = -1;
  int after = -1;
  for (int k = 0; k < fit.problem.landmark_count(); ++k) {
    if (fit.problem.landmarks[idx(k)] == landmark) before = k;
    if (fit.problem.landmarks[idx(k)] == landmark + "'") after = k;
  }
  const Eigen::MatrixXd joint =
      joint_covariance(fit.problem, fit.columns.border, fit.adjustment, {before, after});
  Moved result;
  result.by =
      fit.adjustment.state.landmarks[idx(after)] - fit.adjustment.state.landmarks[idx(before)];
  const Eigen::Matrix<double, 2, 4> difference =
      (Eigen::Matrix<double, 2, 4>() << -1, 0, 1, 0, 0, -1, 0, 1).finished();
  result.covariance = difference * joint.topLeftCorner<4, 4>() * difference.transpose();
  result.chi2 = fit.adjustment.chi2;
  return result;
}

/// The robot of the last session finds one landmark elsewhere, so many standard deviations away.
NoisyDrive with_moved_landmark(double sds, std::uint64_t seed, std::string& landmark) {
  NoisyDrive world = simulate_world({true, true, false, 1, 2}, seed);
  const int which = static_cast<int>(seed % static_cast<std::uint64_t>(world.mesh.landmarks()));
  landmark = landmark_name(world.mesh, which);
  const double angle = static_cast<double>(seed);
  const Vector2 direction(std::cos(angle), std::sin(angle));
  const double sd = std::sqrt(direction.dot(moved_by(world, landmark).covariance * direction));
  Mesh moved = world.mesh;
  moved.positions[idx(which)] += sds * sd * direction;
  // The same walk and the same noise, on the mesh as it is now.
  std::vector<int> walk;
  for (const TrueStop& stop : world.motions.back().stops) walk.push_back(stop.landmark);
  DrivingStyle style;
  style.rest_share = 0.3;
  SimulatedDrive drive = simulate_drive(moved, walk, style, WheeledRobot{}, seed * 16 + 1);
  drive.recording.survey.clear();
  drive.recording.name = world.recordings.back().name;
  world.recordings.back() = std::move(drive.recording);
  return world;
}

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
