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

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::Equipment;
using testing::simulate_recording;

struct Days {
  std::vector<Recording> recordings;
  Model model;
  bool effects = false;  ///< common errors are free
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

EffectParameters border_of(const std::vector<Recording>& recordings, const Days& days) {
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
  rows.holds_heading = map.sessions() == 0 && gauge.hold_heading;
  rows.holds_landmark = map.sessions() == 0 && gauge.hold_landmark;
  rows.state = adjust(rows.problem, rows.border).state;
  std::erase_if(rows.problem.measurements, is_known);
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
};

/// All days at once, to rounding; where nothing measures a direction, in the map's.
Reference adjusted_at_once(const Days& days, SummarisedSessions& map) {
  Reference all;
  all.problem = make_problem(days.recordings, days.model);
  const EffectParameters border = border_of(days.recordings, days);
  const RecordingAdjustment fit = adjust(all.problem, border);
  all.state = fit.state;
  all.coefficients = fit.coefficients;
  RecordingSystem system(all.problem, border);
  system.set_slack(0.0);
  if (system.gauge().hold_heading) {
    all.state.poses.front().heading = map.path(0).poses.front().heading;
  }
  for (int step = 0; step < 20; ++step) {
    all.chi2 = system.linearise(all.state, all.coefficients);
    const RecordingSystem::Step next = system.solve_step();
    all.state = system.moved(all.state, next);
    all.coefficients += next.coefficients;
  }
  return all;
}

double largest_difference(const SummarisedSessions& map, const Reference& all) {
  double largest = 0.0;
  EXPECT_EQ(map.landmarks(), all.problem.landmarks);
  for (std::size_t k = 0; k < all.problem.landmarks.size(); ++k) {
    largest = std::max(
        largest,
        (map.position(static_cast<int>(k)) - all.state.landmarks[k]).cwiseAbs().maxCoeff());
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
      const Days days = days_of(equipment, 5, effects, 21);
      SummarisedSessions map = summarised(days);
      const Reference all = adjusted_at_once(days, map);
      EXPECT_LT(largest_difference(map, all), 1e-8)
          << effects << equipment.compass << equipment.survey << equipment.range_sensor;
      EXPECT_NEAR(map.chi2(), all.chi2, 1e-4);
      const double exact = map.exact_error();
      EXPECT_LT(exact, 1e-8);
      std::printf("diff %g exact %g expected %g anew %d\n", largest_difference(map, all), exact,
                  map.expected_error(), map.taken_anew());
    }
  }
}

}  // namespace
}  // namespace trussmap
