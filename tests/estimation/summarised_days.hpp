// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Days of one robot on one mesh, and their rows as summaries take them.
#pragma once

#include "driven.hpp"
#include "estimation/common_errors.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/simulated_recordings.hpp"
#include "estimation/summarised_sessions.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::testing {

struct Days {
  std::vector<DrivenRecording> recordings;
  Model model;
  bool effects = false;  ///< common errors are free
  bool lever = false;    ///< or where the sensor stands ahead of the axle
};

/// One tour a day, of a mesh with unequal distances, by a robot that measures whatever there is.
inline Days days_of(const WheeledRobot& robot, bool survey, int count, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  Days days;
  for (int k = 0; k < count; ++k) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(k);
    std::mt19937_64 random = random_stream(own, Stream::walk);
    const Tours tours = make_tours(mesh, WalkKind::euler, 1, random);
    days.recordings.push_back(
        testing::driven(simulate_drive(mesh, tours.walk, {}, robot, own).recording));
    days.recordings.back().name = "day " + std::to_string(k + 1);
    if (!survey) days.recordings.back().survey.clear();
  }
  return days;
}

/// One tour a day, of one mesh.
inline Days days_of(const Equipment& equipment, int count, bool effects, std::uint64_t seed) {
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

inline estimation::EffectPattern lever_of(const std::vector<DrivenRecording>& recordings) {
  estimation::EffectPattern result;
  result.name = "lever";
  effects::ViewPattern unit;
  unit.ahead = 1.0;
  for (const DrivenRecording& one : recordings) {
    result.sightings.emplace_back(one.sightings.size(), unit);
  }
  return result;
}

inline estimation::EffectParameters border_of(const std::vector<DrivenRecording>& recordings,
                                              const Days& days) {
  if (days.lever) return {lever_of(recordings)};
  return days.effects ? estimation::common_error_columns(recordings, days.model.robot)
                      : estimation::EffectParameters();
}

inline std::vector<estimation::KnownPlace> known_of(const DrivenRecording& recording,
                                                    const Model& model) {
  std::vector<estimation::KnownPlace> known;
  for (const SurveyPoint& one : recording.survey) {
    known.push_back(
        {one.landmark, {one.x, one.y}, model.noise.survey, one.heading, model.noise.yaw});
  }
  return known;
}

/// A day's rows, laid on the map that there is.
inline estimation::SessionRows rows_of(const DrivenRecording& recording, const Days& days,
                                       const estimation::SummarisedSessions& map) {
  DrivenRecording laid = recording;
  if (map.sessions() > 0) {
    laid.survey.clear();
    for (std::size_t k = 0; k < map.landmarks().size(); ++k) {
      const Vector2 at = map.position(static_cast<int>(k));
      const std::optional<double> turned = map.orientation(static_cast<int>(k));
      laid.survey.push_back(
          {map.landmarks()[k], at.x(), at.y(), 0.02, turned ? *turned : std::nan("")});
    }
  }
  estimation::SessionRows rows;
  rows.problem = estimation::make_problem({laid}, days.model);
  rows.border = border_of({laid}, days);
  const estimation::RecordingGauge gauge = estimation::choose_gauge(rows.problem);
  rows.tells_direction = !gauge.hold_heading;
  rows.tells_position = !gauge.hold_landmark;
  rows.state = estimation::adjust(rows.problem, rows.border).state;
  estimation::drop_survey(rows);
  return rows;
}

}  // namespace trussmap::testing
