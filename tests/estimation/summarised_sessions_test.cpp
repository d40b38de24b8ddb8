// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"

#include "estimation/recording_adjustment.hpp"
#include "estimation/summarised_days.hpp"
#include "trussmap/error.hpp"
#include "trussmap/running.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::summarised_sessions_test {
using namespace estimation;
namespace {

using testing::border_of;
using testing::Days;
using testing::days_of;
using testing::Equipment;
using testing::known_of;
using testing::rows_of;

SummarisedSessions summarised(const Days& days, const SummaryOptions& options = {}) {
  SummarisedSessions map(options);
  for (const DrivenRecording& one : days.recordings) {
    map.add(rows_of(one, days, map), known_of(one, days.model));
  }
  return map;
}

struct Reference {
  RecordingProblem problem;
  RecordingState state;
  Eigen::VectorXd coefficients;
  double chi2 = 0.0;
  int dof = 0;
  bool turns = false;  ///< nothing measures a direction
};

/// All days at once, to rounding.
Reference adjusted_at_once(const Days& days) {
  Reference all;
  all.problem = make_problem(days.recordings, days.model);
  const EffectParameters border = border_of(days.recordings, days);
  const RecordingAdjustment fit = adjust(all.problem, border);
  all.state = fit.state;
  all.coefficients = fit.coefficients;
  all.dof = fit.dof;
  RecordingSystem system(all.problem, border);
  system.set_slack(0.0);
  all.turns = system.gauge().hold_heading;
  for (int step = 0; step < 20; ++step) {
    all.chi2 = system.linearise(all.state, all.coefficients);
    const RecordingSystem::Step next = system.solve_step();
    all.state = system.moved(all.state, next);
    all.coefficients += next.coefficients;
  }
  return all;
}

/// Where nothing measures a direction, after the rotation about the first landmark, which is held.
double largest_difference(const SummarisedSessions& map, const Reference& all) {
  EXPECT_EQ(map.landmarks(), all.problem.landmarks);
  const Vector2 first = all.state.landmarks[0];
  double along = all.turns ? 0.0 : 1.0;
  double across = 0.0;
  for (std::size_t k = 0; all.turns && k < all.state.landmarks.size(); ++k) {
    const Vector2 from = all.state.landmarks[k] - first;
    const Vector2 to = map.position(static_cast<int>(k)) - first;
    along += from.dot(to);
    across += quarter_turn(from).dot(to);
  }
  const Matrix2 R = rotation(std::atan2(across, along));
  double largest = 0.0;
  for (std::size_t k = 0; k < all.problem.landmarks.size(); ++k) {
    const Vector2 there = first + R * (all.state.landmarks[k] - first);
    largest = std::max(largest, (map.position(static_cast<int>(k)) - there).cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < all.problem.oriented.size(); ++k) {
    const double there = all.state.orientations[k] + std::atan2(across, along);
    const std::optional<double> here = map.orientation(all.problem.oriented[k]);
    largest = std::max(largest, here ? std::abs(wrap_angle(*here - there)) : INFINITY);
  }
  if (all.coefficients.size() > 0) {
    largest = std::max(largest, (map.coefficients() - all.coefficients).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(SummarisedSessions, AreTheFitOfAllDays) {
  for (const bool effects : {false, true}) {
    for (const Equipment& equipment :
         {Equipment{true, false, false, 1}, Equipment{true, true, false, 1},
          Equipment{true, false, true, 1}, Equipment{false, true, false, 1},
          Equipment{false, false, false, 1}}) {
      SCOPED_TRACE(::testing::Message()
                   << effects << equipment.compass << equipment.survey << equipment.range_sensor);
      const Days days = days_of(equipment, 5, effects, 21);
      SummarisedSessions map = summarised(days);
      const Reference all = adjusted_at_once(days);
      EXPECT_LT(largest_difference(map, all), 1e-8);
      EXPECT_LT(map.exact_error(), 1e-8);
      EXPECT_NEAR(map.chi2(), all.chi2, 1e-4);
    }
  }
}

/// Views that bend with coefficients, and noise that lasts, which are a path's own unknowns.
TEST(SummarisedSessions, HoldWhereViewsAndLastingNoiseAreCurved) {
  Days days = days_of({true, false, true, 1}, 4, false, 31);
  days.model.noise.processes = {{Channel::bearing, ProcessKind::per_session, 0.01},
                                {Channel::wheels, ProcessKind::correlated_in_distance, 0.01, 2.0},
                                {Channel::range, ProcessKind::correlated_in_t, 0.02, 5.0}};
  days.lever = true;
  SummarisedSessions map = summarised(days);
  EXPECT_EQ(map.coefficients().size(), 1);
  const Reference all = adjusted_at_once(days);
  EXPECT_LT(largest_difference(map, all), 1e-8);
  EXPECT_EQ(map.dof(), all.dof);
}

/// Fixes, loops, landmarks with axes, ranges and bearings alone.
TEST(SummarisedSessions, AreTheFitOfAllDaysWhateverWasMeasured) {
  std::vector<WheeledRobot> robots(5);
  robots[0].fix_rate = 0.5;
  robots[1].loops = true;
  for (const std::size_t k : {2U, 3U}) robots[k].markers = robots[k].range_sensor = true;
  for (const std::size_t k : {3U, 4U}) robots[k].compass = false;
  robots[4].range_sensor = true;
  robots[4].sensor_parts = SensorParts::bearing_alone;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    for (const bool survey : {false, true}) {
      SCOPED_TRACE(::testing::Message() << k << survey);
      const Days days = days_of(robots[k], survey, 3, 101);
      SummarisedSessions map = summarised(days);
      const Reference all = adjusted_at_once(days);
      EXPECT_LT(largest_difference(map, all), 1e-8);
      EXPECT_LT(map.exact_error(), 1e-8);
      EXPECT_NEAR(map.chi2(), all.chi2, 1e-4);
      EXPECT_EQ(map.dof(), all.dof);
    }
  }
}

/// The bounds above are those of a fit: a day left out shows.
TEST(SummarisedSessions, WithoutADayAreNotTheFitOfAll) {
  Days days = days_of({true, false, false, 1}, 5, true, 21);
  const Reference all = adjusted_at_once(days);
  days.recordings.pop_back();
  EXPECT_GT(largest_difference(summarised(days), all), 1e-5);
}

TEST(SummarisedSessions, TakeLandmarksInThatLaterDaysSeeFirst) {
  Days days = days_of(WheeledRobot{}, true, 4, 111);
  for (std::size_t day = 0; day < 3; ++day) {
    std::erase_if(days.recordings[day].sightings, [&](const Sighting& one) {
      return one.landmark == "L1_1" || (day < 2 && one.landmark == "L2_0");
    });
  }
  SummarisedSessions map = summarised(days);
  const Reference all = adjusted_at_once(days);
  EXPECT_EQ(map.landmarks().size(), 9U);
  EXPECT_EQ(map.landmarks().back(), "L1_1");
  EXPECT_LT(largest_difference(map, all), 1e-8);
  EXPECT_EQ(map.dof(), all.dof);
}

/// The turn is about that landmark then, wherever the first one lies.
TEST(SummarisedSessions, TurnAboutTheOnlyPlaceThatIsKnown) {
  WheeledRobot robot;
  robot.compass = false;
  Days days = days_of(robot, true, 3, 121);
  for (const std::string known : {"L0_2", "L2_0", "L2_2"}) {
    Days one = days;
    for (DrivenRecording& recording : one.recordings) {
      std::erase_if(recording.survey,
                    [&](const SurveyPoint& point) { return point.landmark != known; });
    }
    SummarisedSessions map = summarised(one);
    const Reference all = adjusted_at_once(one);
    EXPECT_LT(map.exact_error(), 1e-8);
    EXPECT_NEAR(map.chi2(), all.chi2, 1e-4);
    EXPECT_EQ(map.dof(), all.dof);
    for (std::size_t k = 1; k < map.landmarks().size(); ++k) {
      const double here = (map.position(static_cast<int>(k)) - map.position(0)).norm();
      const double there = (all.state.landmarks[k] - all.state.landmarks[0]).norm();
      EXPECT_NEAR(here, there, 1e-8);
    }
  }
}

/// A day that hangs on one landmark alone can turn about it; so can a path that sees but one.
TEST(SummarisedSessions, ThatCanTurnAreRefused) {
  WheeledRobot robot;
  robot.compass = false;
  Days days = days_of(robot, false, 2, 131);
  SummarisedSessions map;
  map.add(rows_of(days.recordings[0], days, map));
  const std::vector<std::string> names = map.landmarks();
  for (const std::string& only : names) {
    DrivenRecording hanging = days.recordings[1];
    for (Sighting& one : hanging.sightings) {
      if (one.landmark != only) one.landmark.insert(0, "other ");
    }
    try {
      map.add(rows_of(hanging, days, map));
      ADD_FAILURE() << only;
    } catch (const SolveError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("day 2 can turn about landmark " + only, 0), 0U)
          << error.what();
    }
    EXPECT_EQ(map.sessions(), 1);
    DrivenRecording single = days.recordings[1];
    std::erase_if(single.sightings, [&](const Sighting& one) { return one.landmark != only; });
    if (single.sightings.size() < 2) continue;
    EXPECT_THROW(map.add(rows_of(single, days, map)), SolveError) << only;
    SummarisedSessions none;
    EXPECT_THROW(none.add(rows_of(single, days, none)), SolveError) << only;
  }
  map.add(rows_of(days.recordings[1], days, map));
  EXPECT_LT(map.exact_error(), 1e-8);
}

/// Unless that landmark has an axis, which both have read.
TEST(SummarisedSessions, MayHangOnALandmarkWithAnAxis) {
  WheeledRobot robot;
  robot.compass = false;
  robot.markers = true;
  Days days = days_of(robot, false, 2, 135);
  for (Sighting& one : days.recordings[1].sightings) {
    if (one.landmark != "L1_1") one.landmark.insert(0, "other ");
  }
  SummarisedSessions map = summarised(days);
  const Reference all = adjusted_at_once(days);
  EXPECT_EQ(map.landmarks().size(), 17U);
  EXPECT_LT(largest_difference(map, all), 1e-8);
  EXPECT_EQ(map.dof(), all.dof);
}

/// As an adjustment does, where the gate leaves out every yaw of a landmark.
TEST(SummarisedSessions, AnOrientationOfWhichNoYawIsLeftStays) {
  WheeledRobot robot;
  robot.markers = true;
  const Days days = days_of(robot, false, 2, 141);
  SummarisedSessions map;
  SessionRows rows = rows_of(days.recordings[0], days, map);
  rows.weights.assign(rows.problem.measurements.size(), 1.0);
  const int unseen = rows.problem.pose_end() + 3;
  for (std::size_t k = 0; k < rows.weights.size(); ++k) {
    if (rows.problem.measurements[k].to == unseen) rows.weights[k] = 0.0;
  }
  const double before = rows.state.orientations[3];
  const int landmark = rows.problem.oriented[3];
  map.add(std::move(rows));
  ASSERT_TRUE(map.orientation(landmark));
  EXPECT_EQ(*map.orientation(landmark), before);
  map.add(rows_of(days.recordings[1], days, map));  // which reads it
  EXPECT_NE(*map.orientation(landmark), before);
  EXPECT_LT(map.exact_error(), 1e-8);
}

/// As in an adjustment of all: a second survey of the same numbers may bring a heading.
TEST(SummarisedSessions, KnowAPlaceOnce) {
  WheeledRobot robot;
  robot.markers = true;
  Days days = days_of(robot, true, 2, 151);
  for (std::size_t k = 0; k < days.recordings[0].survey.size(); ++k) {
    SurveyPoint& first = days.recordings[0].survey[k];
    SurveyPoint& second = days.recordings[1].survey[k];
    ASSERT_EQ(first.landmark, second.landmark);
    second.x = first.x;
    second.y = first.y;
    first.heading = std::nan("");
  }
  SummarisedSessions map = summarised(days);
  const Reference all = adjusted_at_once(days);
  EXPECT_LT(largest_difference(map, all), 1e-8);
  EXPECT_NEAR(map.chi2(), all.chi2, 1e-4);
  EXPECT_EQ(map.dof(), all.dof);
}

TEST(SummarisedSessions, InAnotherOrderAreTheSame) {
  Days days = days_of({true, false, false, 1}, 5, true, 41);
  const SummarisedSessions map = summarised(days);
  std::reverse(days.recordings.begin() + 1, days.recordings.end());  // the first defines the datum
  const SummarisedSessions other = summarised(days);
  EXPECT_LT((map.coefficients() - other.coefficients()).cwiseAbs().maxCoeff(), 2e-8);
  for (int k = 0; k < static_cast<int>(map.landmarks().size()); ++k) {
    EXPECT_EQ(map.landmarks()[idx(k)], other.landmarks()[idx(k)]);
    EXPECT_LT((map.position(k) - other.position(k)).norm(), 2e-8);
  }
}

/// And on other numbers of threads.
TEST(SummarisedSessions, GiveTheSameBitsAgain) {
  const Days days = days_of({true, false, true, 1}, 3, true, 51);
  const SummarisedSessions map = summarised(days);
  for (const int count : {1, 3}) {
    set_threads(count);
    const SummarisedSessions again = summarised(days);
    set_threads(1);
    EXPECT_EQ(map.coefficients(), again.coefficients());
    EXPECT_EQ(map.chi2(), again.chi2());
    for (int k = 0; k < static_cast<int>(map.landmarks().size()); ++k) {
      EXPECT_EQ(map.position(k), again.position(k));
    }
  }
}

TEST(SummarisedSessions, KeepToACoarserToleranceWithLessWork) {
  const Days days = days_of({true, false, false, 1}, 8, false, 61);
  SummarisedSessions fine = summarised(days);
  SummarisedSessions coarse = summarised(days, {1e-5});
  EXPECT_LT(fine.exact_error(), 1e-8);
  EXPECT_LT(coarse.exact_error(), 1e-5);
  EXPECT_GT(coarse.exact_error(), 1e-8);
  EXPECT_LT(coarse.relinearised(), fine.relinearised());
}

/// To the last bit, and what comes after it is as if it had never been tried.
TEST(SummarisedSessions, ASessionThatFailsChangesNothing) {
  const Days days = days_of({true, false, false, 1}, 3, true, 71);
  SummarisedSessions map = summarised(days);
  SummarisedSessions untouched = summarised(days);
  const auto expect_untouched = [&] {
    EXPECT_EQ(map.sessions(), untouched.sessions());
    EXPECT_EQ(map.landmarks(), untouched.landmarks());
    EXPECT_EQ(map.coefficients(), untouched.coefficients());
    EXPECT_EQ(map.coefficient_covariance(), untouched.coefficient_covariance());
    EXPECT_EQ(map.landmark_covariances(), untouched.landmark_covariances());
    EXPECT_EQ(map.chi2(), untouched.chi2());
    EXPECT_EQ(map.dof(), untouched.dof());
    EXPECT_EQ(map.relinearised(), untouched.relinearised());
    for (int k = 0; k < static_cast<int>(untouched.landmarks().size()); ++k) {
      EXPECT_EQ(map.position(k), untouched.position(k));
    }
  };
  SummarisedSessions none;
  SessionRows elsewhere = rows_of(days.recordings[0], days, none);
  for (std::string& name : elsewhere.problem.landmarks) name.insert(0, "other ");
  EXPECT_THROW(map.add(std::move(elsewhere)), SolveError);
  expect_untouched();
  SessionRows told_nothing = rows_of(days.recordings[0], days, map);
  told_nothing.problem.landmarks.back() = "new";
  told_nothing.weights.assign(told_nothing.problem.measurements.size(), 1.0);
  const int last = told_nothing.problem.landmark_count() - 1;
  for (std::size_t k = 0; k < told_nothing.weights.size(); ++k) {
    if (told_nothing.problem.measurements[k].to == last) told_nothing.weights[k] = 0.0;
  }
  // The others have been taken anew, by Gauss's and Newton's derivatives, when it is given up.
  EXPECT_THROW(map.add(std::move(told_nothing), {{"L9_9", {1.0, 2.0}, 0.1}}), SolveError);
  expect_untouched();
  SessionRows of_two = rows_of(days.recordings[0], days, map);
  of_two.problem.sessions.emplace_back("another");
  EXPECT_THROW(map.add(std::move(of_two)), std::invalid_argument);
  expect_untouched();
  EXPECT_LT(map.exact_error(), 1e-8);
  map.add(rows_of(days.recordings[0], days, map));
  untouched.add(rows_of(days.recordings[0], days, untouched));
  expect_untouched();
}

/// Not even the first.
TEST(SummarisedSessions, MayBeginAgainAfterAFirstSessionThatFails) {
  const Days days = days_of({true, false, false, 1}, 1, true, 72);
  SummarisedSessions map;
  SessionRows told_nothing = rows_of(days.recordings[0], days, map);
  told_nothing.weights.assign(told_nothing.problem.measurements.size(), 0.0);
  EXPECT_THROW(map.add(std::move(told_nothing)), SolveError);
  EXPECT_EQ(map.sessions(), 0);
  EXPECT_EQ(map.chi2(), 0.0);
  EXPECT_EQ(map.dof(), 0);
  EXPECT_EQ(map.exact_error(), 0.0);
  EXPECT_TRUE(map.landmark_covariances().empty());
  EXPECT_EQ(map.coefficient_covariance().size(), 0);
  map.add(rows_of(days.recordings[0], days, map));
  EXPECT_LT(map.exact_error(), 1e-8);
}

TEST(SummarisedSessions, RefuseOtherCoefficients) {
  Days days = days_of({true, false, false, 1}, 2, true, 81);
  SummarisedSessions map;
  map.add(rows_of(days.recordings[0], days, map));
  days.effects = false;
  EXPECT_THROW(map.add(rows_of(days.recordings[1], days, map)), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::summarised_sessions_test
