// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/measured_doubts.hpp"

#include "build_map/map_doubts.hpp"
#include "estimation/kinds/independent_rows.hpp"
#include "map/common_landmarks.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::map_building {
namespace {

constexpr double kFar = 10.0;      // standard errors
constexpr double kNoticed = 0.02;  // of the extent
constexpr double kMends = 0.2;     // of the distance, left by what explains it

/// Whether so large a distance contradicts places that are so exact, and is worth a word.
bool contradicts(double rms, double sd, double extent) {
  return rms > std::max(kFar * sd, kNoticed * extent);
}

double survey_sd(const std::vector<SurveyPoint>& points, const Noise& noise) {
  std::vector<double> sds;
  sds.reserve(points.size());
  for (const SurveyPoint& one : points) sds.push_back(estimation::stated_or(one.sd, noise.survey));
  return statistics::median(std::move(sds));
}

/// Places by the map, and by what it is held against.
struct Places {
  std::vector<Vector2> in_map;
  std::vector<Vector2> measured;
};

/// What makes the map fit the survey, or the truth, in words.
std::string explanation(const Places& places, const std::string& what, const char* otherwise) {
  const double mended = kMends * align_rigidly(places.in_map, places.measured).rms;
  std::vector<Vector2> mirrored = places.measured;
  for (Vector2& one : mirrored) one.y() = -one.y();
  if (align_rigidly(places.in_map, mirrored).rms < mended) {
    return "; it fits the mirrored " + what +
           ": are x and y exchanged there, has one the wrong sign, or "
           "are the left and the right wheel exchanged?";
  }
  const Alignment similar = align_by_similarity(places.in_map, places.measured);
  if (similar.rms < mended) {
    const double factor = similar.scale;
    return text::joined("; it fits a map ",
                        text::short_text(factor > 1.0 ? factor : 1.0 / factor, 3),
                        factor > 1.0 ? " times as large" : " times as small", ": is the ", what,
                        " in another unit, or is the wheels' travel off by as much?");
  }
  if (align_by_similarity(places.in_map, mirrored).rms < mended) {
    return "; it fits the mirrored " + what + " in another unit";
  }
  return otherwise;
}

/// The truth's place at a time, between rows that are not far apart.
std::optional<Vector2> truth_at(const std::vector<TruthRow>& truth, double t) {
  constexpr double kGap = 0.5;  // s
  const auto after = std::lower_bound(truth.begin(), truth.end(), t,
                                      [](const TruthRow& row, double at) { return row.t < at; });
  if (after == truth.end()) return std::nullopt;
  if (after->t == t) return Vector2(after->x, after->y);
  if (after == truth.begin() || after->t - (after - 1)->t > kGap) return std::nullopt;
  const TruthRow& before = *(after - 1);
  const double share = (t - before.t) / (after->t - before.t);
  return Vector2(before.x + share * (after->x - before.x),
                 before.y + share * (after->y - before.y));
}

/// Where a session's robot was when it saw landmarks, by the adjustment and by its truth.
Places tracked_places(const fitting::FitState& fit, const std::vector<TruthRow>& truth,
                      int session) {
  Places places;
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    const estimation::PoseNode& node = fit.problem.poses[k];
    if (node.session != session) continue;
    const std::optional<Vector2> at = truth_at(truth, node.t);
    if (!at) continue;
    places.in_map.push_back(fit.adjustment.state.poses[k].position());
    places.measured.push_back(*at);
  }
  return places;
}

}  // namespace

void doubt_against_survey(BuiltMap& built, const Noise& noise) {
  if (!built.on_survey) return;
  const SurveyComparison& comparison = built.on_survey->comparison;
  if (!comparison.contradicting.empty()) {
    const bool exchanged = 2 * comparison.exchanged.size() == comparison.contradicting.size();
    built.warnings.push_back(text::joined("the survey contradicts the map at ",
                                          listed(comparison.contradicting),
                                          exchanged ? ": exchanged labels" : ""));
  }
  const double sd = std::hypot(built.quality.median_sd, built.quality.from_adjusted,
                               survey_sd(built.on_survey->points, noise));
  const map::CommonLandmarks common = map::common_landmarks(
      positions_of(built.map), built.on_survey->points, comparison.contradicting);
  if (!contradicts(comparison.rigid.rms, sd, extent_of(common.in_map))) return;
  built.warnings.push_back(text::joined(
      "the survey contradicts the map, by ", text::short_text(comparison.rigid.rms, 3), " m (rms)",
      explanation({common.in_map, common.surveyed}, "survey",
                  "; is it of another place, or are names exchanged?")));
}

void doubt_against_truth(BuiltMap& built, const fitting::FitState& fit,
                         const std::vector<DrivenRecording>& recordings) {
  constexpr std::size_t kFewest = 5;
  constexpr double kOffAxle = 0.1;  // of the extent: a tracker's point is somewhere on the robot
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const Places places = tracked_places(fit, recordings[s].truth, static_cast<int>(s));
    if (places.in_map.size() < kFewest) continue;
    const double rms = align_rigidly(places.in_map, places.measured).rms;
    const double extent = extent_of(places.in_map);
    if (!contradicts(rms, built.quality.median_sd, extent) || rms < kOffAxle * extent) continue;
    built.warnings.push_back(text::joined(
        recordings.size() > 1 ? recordings[s].name + ": " : std::string(),
        "the truth contradicts where the map has the robot, by ", text::short_text(rms, 3),
        " m (rms)",
        explanation(places, "truth", "; is it of another drive, or is its clock another one?")));
  }
}

void doubt_against_truth(BuiltMap& built) {
  for (const BuiltPath& path : built.paths) {
    if (!path.on_truth) continue;
    if (!contradicts(path.on_truth->rms, path.median_sd, extent_of(path.adjusted))) continue;
    built.warnings.push_back(
        text::joined(built.paths.size() > 1 ? path.recording + ": " : std::string(),
                     "the truth contradicts the path, by ", text::short_text(path.on_truth->rms, 3),
                     " m (rms): is the path's scale wrong, or the truth's unit?"));
  }
}

}  // namespace trussmap::map_building
