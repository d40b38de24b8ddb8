// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"

#include "estimation/common_errors.hpp"
#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::Equipment;
using testing::simulate_recording;

struct Days {
  std::vector<Recording> recordings;
  Model model;
  bool effects = false;  ///< common errors are free
  bool lever = false;    ///< or where the sensor stands ahead of the axle
};

/// One tour a day, of one mesh.
Days days_of(const Equipment& equipment, int count, bool effects, std::uint64_t seed) {
  Days days;
  days.effects = effects;
  for (int k = 0; k < count; ++k) {
    const auto one = simulate_recording(equipment, seed + static_cast<std::uint64_t>(k));
    days.recordings.push_back(one.recording);
    days.recordings.back().name = "day " + std::to_string(k + 1);
    days.model = one.model;
  }
  return days;
}

EffectPattern lever_of(const std::vector<Recording>& recordings) {
  EffectPattern result;
  result.name = "lever";
  ViewPattern unit;
  unit.ahead = 1.0;
  for (const Recording& one : recordings) {
    result.sightings.emplace_back(one.sightings.size(), unit);
  }
  return result;
}

EffectParameters border_of(const std::vector<Recording>& recordings, const Days& days) {
  if (days.lever) return {lever_of(recordings)};
  return days.effects ? common_error_columns(recordings, days.model.robot) : EffectParameters();
}

bool is_known(const Measurement& one) {
  return one.kind == MeasurementKind::survey || one.kind == MeasurementKind::survey_heading;
}

std::vector<KnownPlace> known_of(const Recording& recording, const Model& model) {
  std::vector<KnownPlace> known;
  for (const SurveyPoint& one : recording.survey) {
    known.push_back({one.landmark, {one.x, one.y}, model.noise.survey, one.heading, 0.01});
  }
  return known;
}

/// A day's rows, laid on the map that there is.
SessionRows rows_of(const Recording& recording, const Days& days, const SummarisedSessions& map) {
  Recording laid = recording;
  if (map.sessions() > 0) {
    laid.survey.clear();
    for (std::size_t k = 0; k < map.landmarks().size(); ++k) {
      const Vector2 at = map.position(static_cast<int>(k));
      laid.survey.push_back({map.landmarks()[k], at.x(), at.y(), 0.02});
    }
  }
  SessionRows rows;
  rows.problem = make_problem({laid}, days.model);
  rows.border = border_of({laid}, days);
  const RecordingGauge gauge = choose_gauge(rows.problem);
  rows.tells_direction = !gauge.hold_heading;
  rows.tells_position = !gauge.hold_landmark;
  rows.state = adjust(rows.problem, rows.border).state;
  while (is_known(rows.problem.measurements.back())) rows.problem.measurements.pop_back();
  if (!rows.problem.noise_terms.empty()) {
    rows.problem.noise_terms.resize(rows.problem.measurements.size());
    rows.problem.within.resize(rows.problem.measurements.size());
  }
  return rows;
}

SummarisedSessions summarised(const Days& days, const SummaryOptions& options = {}) {
  SummarisedSessions map(options);
  for (const Recording& one : days.recordings) {
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

TEST(SummarisedSessions, InAnotherOrderAreTheSame) {
  Days days = days_of({true, false, false, 1}, 5, true, 41);
  const SummarisedSessions map = summarised(days);
  std::reverse(days.recordings.begin() + 1, days.recordings.end());  // the first lays the frame
  const SummarisedSessions other = summarised(days);
  EXPECT_LT((map.coefficients() - other.coefficients()).cwiseAbs().maxCoeff(), 2e-8);
  for (int k = 0; k < static_cast<int>(map.landmarks().size()); ++k) {
    EXPECT_EQ(map.landmarks()[idx(k)], other.landmarks()[idx(k)]);
    EXPECT_LT((map.position(k) - other.position(k)).norm(), 2e-8);
  }
}

TEST(SummarisedSessions, GiveTheSameBitsAgain) {
  const Days days = days_of({true, false, true, 1}, 3, true, 51);
  const SummarisedSessions map = summarised(days);
  const SummarisedSessions again = summarised(days);
  EXPECT_EQ(map.coefficients(), again.coefficients());
  for (int k = 0; k < static_cast<int>(map.landmarks().size()); ++k) {
    EXPECT_EQ(map.position(k), again.position(k));
  }
}

TEST(SummarisedSessions, KeepToACoarserToleranceWithLessWork) {
  const Days days = days_of({true, false, false, 1}, 8, false, 61);
  SummarisedSessions fine = summarised(days);
  SummarisedSessions coarse = summarised(days, {1e-5});
  EXPECT_LT(fine.exact_error(), 1e-8);
  EXPECT_LT(coarse.exact_error(), 1e-5);
  EXPECT_GT(coarse.exact_error(), 1e-8);
  EXPECT_LT(coarse.taken_anew(), fine.taken_anew());
}

TEST(SummarisedSessions, ASessionThatFailsChangesNothing) {
  const Days days = days_of({true, false, false, 1}, 3, false, 71);
  SummarisedSessions map = summarised(days);
  SummarisedSessions none;
  SessionRows elsewhere = rows_of(days.recordings[0], days, none);
  for (std::string& name : elsewhere.problem.landmarks) name.insert(0, "other ");
  SessionRows told_nothing = rows_of(days.recordings[0], days, map);
  told_nothing.problem.landmarks.back() = "new";
  told_nothing.weights.assign(told_nothing.problem.measurements.size(), 0.0);
  const Vector2 before = map.position(3);
  const double chi2 = map.chi2();
  const std::size_t landmarks = map.landmarks().size();
  EXPECT_THROW(map.add(elsewhere), SolveError);
  EXPECT_THROW(map.add(told_nothing), SolveError);
  EXPECT_EQ(map.sessions(), 3);
  EXPECT_EQ(map.landmarks().size(), landmarks);
  EXPECT_EQ(map.position(3), before);
  EXPECT_NEAR(map.chi2(), chi2, 1e-8);
  map.add(rows_of(days.recordings[0], days, map));  // and it goes on
  EXPECT_LT(map.exact_error(), 1e-8);
}

TEST(SummarisedSessions, RefuseOtherCoefficients) {
  Days days = days_of({true, false, false, 1}, 2, true, 81);
  SummarisedSessions map;
  map.add(rows_of(days.recordings[0], days, map));
  days.effects = false;
  EXPECT_THROW(map.add(rows_of(days.recordings[1], days, map)), std::invalid_argument);
}

/// H is the derivative of g, and g that of phi, by differences.
TEST(SessionSummary, IsTheQuadraticOfItsSession) {
  Days days = days_of({true, false, true, 1}, 1, false, 91);
  days.model.noise.processes = {{Channel::bearing, ProcessKind::correlated_in_t, 0.01, 5.0}};
  days.lever = true;
  SummarisedSessions none;
  SessionRows rows = rows_of(days.recordings[0], days, none);
  const RecordingState state = rows.state;
  SessionSummary summary(std::move(rows));
  Eigen::VectorXd u = summary.shared_of(state, Eigen::VectorXd::Constant(1, 0.02));
  for (Eigen::Index k = 0; k < u.size() - 1; ++k) u[k] += 0.003 * std::sin(static_cast<double>(k));
  summary.linearise(u);
  const SessionSummary::Quadratic& one = summary.quadratic();
  constexpr double kStep = 1e-4;
  for (const Eigen::Index k : {Eigen::Index{0}, Eigen::Index{5}, u.size() - 1}) {
    const Eigen::VectorXd move = kStep * Eigen::VectorXd::Unit(u.size(), k);
    const auto above = summary.value_at(u + move);
    const auto below = summary.value_at(u - move);
    const double slope = (above.half_chi2 - below.half_chi2) / (2.0 * kStep);
    EXPECT_NEAR(slope, one.gradient[k], 1e-4 * one.gradient.norm());
    const Eigen::VectorXd column = (above.gradient - below.gradient) / (2.0 * kStep);
    EXPECT_LT((column - one.information.col(k)).norm(), 1e-5 * one.information.col(k).norm());
  }
}

}  // namespace
}  // namespace trussmap
