// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/compare.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>
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

namespace {

/// One frame in so long; where errors of sightings last, for that.
void thin(PreparedRecordings& prepared, double every, bool lasts) {
  const std::size_t all = sightings_of(prepared.recordings);
  prepared.sightings = {all, all, 0.0};
  if (!(every > 0.0)) return;
  std::vector<DrivenRecording> thinned = thinned_frames(prepared.recordings, every);
  const std::size_t used = sightings_of(thinned);
  if (used == all) return;
  prepared.recordings = std::move(thinned);
  prepared.sightings = {used, all, every};
  prepared.notes.push_back(fmt::format(
      "of {} sightings {} are used, one frame in {:g} s{}", all, used, every,
      lasts ? ": errors of sightings last so long in this model (--every 0: all)" : ""));
}

/// As a model has the whole of them.
void judge_rows(PreparedRecordings& prepared, const Model& model) {
  FitOptions how = prepared.fit;
  how.use_survey = false;
  prepared.recordings = *prepared.whole;
  const ModelFit without_survey = fit_model(prepared.recordings, model, how);
  if (prepared.fit.use_survey) leave_contradicting_points_out(prepared, without_survey);
  thin(prepared, lasting_errors(without_survey).lasts, true);
}

}  // namespace

PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings, const Model& model,
                                      const FitOptions& fit, std::optional<double> every) {
  PreparedRecordings prepared;
  prepared.fit = fit;
  if (!every && has_dense_frames(recordings)) {
    prepared.whole = std::make_shared<const std::vector<DrivenRecording>>(std::move(recordings));
    judge_rows(prepared, model);
    return prepared;
  }
  prepared.recordings = std::move(recordings);
  thin(prepared, every.value_or(0.0), false);
  return prepared;
}

PreparedRecordings prepared_again(const PreparedRecordings& prepared, const Model& model) {
  if (!prepared.whole) return prepared;
  PreparedRecordings again;
  again.whole = prepared.whole;
  again.fit = prepared.fit;
  judge_rows(again, model);
  return again;
}

bool use_the_same(const PreparedRecordings& one, const PreparedRecordings& other) {
  constexpr double kSame = 1e-6;  // of the time between frames
  const UsedSightings& a = one.sightings;
  const UsedSightings& b = other.sightings;
  if (a.used != b.used || a.all != b.all || std::abs(a.every - b.every) > kSame * a.every) {
    return false;
  }
  const auto same_point = [](const SurveyPoint& p, const SurveyPoint& q) {
    return p.landmark == q.landmark;
  };
  return std::equal(one.recordings.begin(), one.recordings.end(), other.recordings.begin(),
                    other.recordings.end(), [&](const auto& p, const auto& q) {
                      return std::equal(p.survey.begin(), p.survey.end(), q.survey.begin(),
                                        q.survey.end(), same_point);
                    });
}

}  // namespace trussmap
