// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/compare.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
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

/// One frame in so long, of what there is.
void thin(PreparedRecordings& prepared, double every, std::string_view why) {
  if (every > 0.0) prepared.recordings = thinned_frames(prepared.recordings, every);
  const std::size_t used = sightings_of(prepared.recordings);
  prepared.sightings = {used, prepared.recorded, used < prepared.recorded ? every : 0.0};
  if (!prepared.sightings.thinned()) return;
  if (prepared.whole && !prepared.could_be_more()) {
    prepared.sightings.every = prepared.pace;
    why = ": more take long and tell little more (--every 0: all)";
  }
  prepared.notes.push_back(fmt::format("of {} sightings {} are used, one frame in {:g} s{}",
                                       prepared.recorded, used, prepared.sightings.every, why));
}

/// As a model has them.
void judge_rows(PreparedRecordings& prepared, const Model& model) {
  FitOptions how = prepared.fit;
  how.use_survey = false;
  prepared.recordings = *prepared.whole;
  const ModelFit without_survey = fit_model(prepared.recordings, model, how);
  if (prepared.fit.use_survey) leave_contradicting_points_out(prepared, without_survey);
  thin(prepared, lasting_errors(without_survey).lasts,
       ": errors of sightings last so long in this model (--every 0: all)");
}

/// Frames so far apart that there are enough and no more; returns how far, s, 0: all are left.
double pace(std::vector<DrivenRecording>& recordings) {
  constexpr double kStep = 0.1;  // s
  constexpr int kMost = 10;
  constexpr std::size_t kMany = 30000;  // fewer are soon judged, and errors that last seen finer
  if (sightings_of(recordings) <= kMany) return 0.0;
  std::vector<DrivenRecording> paced;
  int steps = 0;
  do {
    paced = richest_frames(recordings, kStep * ++steps);
  } while (steps < kMost && sightings_of(paced) > kEnoughSightings);
  recordings = std::move(paced);
  return kStep * steps;
}

}  // namespace

bool PreparedRecordings::could_be_more() const {
  return whole && sightings.used < sightings_of(*whole);
}

PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings, const Model& model,
                                      const FitOptions& fit, std::optional<double> every) {
  PreparedRecordings prepared;
  prepared.fit = fit;
  prepared.recorded = sightings_of(recordings);
  if (!every && has_dense_frames(recordings)) {
    prepared.pace = pace(recordings);
    prepared.whole = std::make_shared<const std::vector<DrivenRecording>>(std::move(recordings));
    judge_rows(prepared, model);
    return prepared;
  }
  prepared.recordings = std::move(recordings);
  thin(prepared, every.value_or(0.0), "");
  return prepared;
}

PreparedRecordings prepared_again(const PreparedRecordings& prepared, const Model& model) {
  if (!prepared.whole) return prepared;
  PreparedRecordings again;
  again.whole = prepared.whole;
  again.recorded = prepared.recorded;
  again.pace = prepared.pace;
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
