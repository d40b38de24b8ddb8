// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/prepared_recordings.hpp"

#include "trussmap/survey_comparison.hpp"

#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::size_t sightings_of(const std::vector<DrivenRecording>& recordings) {
  std::size_t sum = 0;
  for (const DrivenRecording& one : recordings) sum += one.sightings.size();
  return sum;
}

/// Survey points that contradict a map made without the survey are no measurements.
void leave_contradicting_points_out(PreparedRecordings& prepared, const ModelFit& without_survey) {
  LandmarkPositions positions;
  for (const FittedLandmark& one : without_survey.landmarks) positions[one.name] = one.position;
  for (DrivenRecording& recording : prepared.recordings) {
    const SurveyComparison comparison = compare_with_survey(positions, recording.survey);
    for (const std::string& name : comparison.contradicting) {
      std::erase_if(recording.survey,
                    [&name](const SurveyPoint& point) { return point.landmark == name; });
      prepared.notes.push_back(
          fmt::format("landmark {}: its survey contradicts all the others, and is left out", name));
    }
  }
}

}  // namespace

FitOptions gated_fit(double gate) {
  FitOptions options;
  if (gate > 0.0) options.gate = gate * gate;
  options.most_left_out = kMostLeftOut;
  return options;
}

PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings, const Model& model,
                                      const FitOptions& fit, std::optional<double> every) {
  PreparedRecordings prepared;
  prepared.recordings = std::move(recordings);
  double lasts = every.value_or(0.0);
  if (!every && has_dense_frames(prepared.recordings)) {
    FitOptions how = fit;
    how.use_survey = false;
    const ModelFit without_survey = fit_model(prepared.recordings, model, how);
    lasts = lasting_errors(without_survey).lasts;
    if (fit.use_survey) leave_contradicting_points_out(prepared, without_survey);
  }
  if (!(lasts > 0.0)) return prepared;
  std::vector<DrivenRecording> thinned = thinned_frames(prepared.recordings, lasts);
  const std::size_t all = sightings_of(prepared.recordings);
  const std::size_t used = sightings_of(thinned);
  if (used == all) return prepared;
  prepared.recordings = std::move(thinned);
  prepared.notes.push_back(
      fmt::format("of {} sightings {} are used, one frame in {:g} s{}", all, used, lasts,
                  every ? "" : ": errors of sightings last so long (--every 0: all)"));
  return prepared;
}

}  // namespace trussmap
