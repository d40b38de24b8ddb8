// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/build_map.hpp"

#include "build_map/adjusted_map.hpp"
#include "build_map/leg_by_leg.hpp"
#include "build_map/map_doubts.hpp"
#include "recording/well_formed.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"

#include <map>
#include <stdexcept>

namespace trussmap {
namespace {

constexpr int kFewestSurveyed = 3;

void check(const std::vector<Recording>& recordings, const BuildMapOptions& options) {
  if (recordings.empty()) throw std::invalid_argument("a map needs a recording");
  require_well_formed(recordings);
  if (!(options.gate.value_or(kMapGate) > 0.0) || !(options.map_sd >= 0.0) || options.looks < 1 ||
      options.settle < 0 || options.confirmations < 1 || !(options.bearing_slack >= 0.0) ||
      !(options.min_drive >= 0.0)) {
    throw std::invalid_argument("an option of build_map is out of range");
  }
}

std::vector<SightedDrive> sessions_of(const std::vector<ClearedRecording>& cleared,
                                      const Model& model) {
  std::vector<SightedDrive> sessions;
  for (const ClearedRecording& one : cleared) {
    if (one.recording.sightings.empty()) {
      throw InputError(one.recording.name, 0,
                       "no landmark was sighted, expected sightings to build a map from");
    }
    sessions.emplace_back(one, model);
  }
  return sessions;
}

std::vector<SurveyPoint> survey_of(const std::vector<Recording>& recordings) {
  std::map<std::string, SurveyPoint> survey;
  for (const Recording& recording : recordings) {
    for (const SurveyPoint& point : recording.survey) survey.try_emplace(point.landmark, point);
  }
  std::vector<SurveyPoint> result;
  result.reserve(survey.size());
  for (const auto& [name, point] : survey) result.push_back(point);
  return result;
}

std::optional<MapOnSurvey> laid_on_survey(const BuiltMap& built,
                                          const std::vector<Recording>& recordings) {
  MapOnSurvey result;
  result.points = survey_of(recordings);
  result.comparison = compare_with_survey(positions_of(built.map), result.points);
  if (result.comparison.landmarks < kFewestSurveyed) return std::nullopt;
  result.rms_dead_reckoning =
      survey_rms(built.dead_reckoned, result.points, result.comparison.contradicting);
  return result;
}

}  // namespace

BuiltMap build_map(const std::vector<Recording>& recordings, const Model& model,
                   const BuildMapOptions& options) {
  check(recordings, options);
  const std::vector<ClearedRecording> clear = cleared(recordings, model);
  const std::vector<SightedDrive> sessions = sessions_of(clear, model);
  BuiltMap built = options.method == Method::adjustment
                       ? map_by_adjustment(recordings, model, sessions, options)
                       : map_leg_by_leg(sessions, {options, options.gate.value_or(kMapGate), {}});
  built.on_survey = laid_on_survey(built, recordings);
  const std::vector<std::string> doubts = doubts_of(built, recordings, model);
  built.warnings.insert(built.warnings.begin(), doubts.begin(), doubts.end());
  return built;
}

}  // namespace trussmap
