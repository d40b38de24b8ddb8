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
#include <string>
#include <vector>

namespace trussmap {
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
  for (const SurveyPoint& one : points) sds.push_back(stated_or(one.sd, noise.survey));
  return median(std::move(sds));
}

/// What makes the map fit the survey, in words.
std::string explanation(const SurveyComparison& found, const CommonLandmarks& common) {
  const double mended = kMends * found.rigid.rms;
  std::vector<Vector2> mirrored = common.surveyed;
  for (Vector2& one : mirrored) one.y() = -one.y();
  if (align_rigidly(common.in_map, mirrored).rms < mended) {
    return "; it fits the mirrored survey: are x and y exchanged there, has one the wrong sign, or "
           "are the left and the right wheel exchanged?";
  }
  if (found.similarity.rms < mended) {
    const double factor = found.similarity.scale;
    return joined("; it fits a map ", short_text(factor > 1.0 ? factor : 1.0 / factor, 3),
                  factor > 1.0 ? " times as large" : " times as small",
                  ": is the survey in another unit, or is the wheels' travel off by as much?");
  }
  if (align_by_similarity(common.in_map, mirrored).rms < mended) {
    return "; it fits the mirrored survey in another unit";
  }
  return "; is it of another place, or are names exchanged?";
}

}  // namespace

void doubt_against_survey(BuiltMap& built, const Noise& noise) {
  if (!built.on_survey) return;
  const SurveyComparison& comparison = built.on_survey->comparison;
  if (!comparison.contradicting.empty()) {
    const bool exchanged = 2 * comparison.exchanged.size() == comparison.contradicting.size();
    built.warnings.push_back(joined("the survey contradicts the map at ",
                                    listed(comparison.contradicting),
                                    exchanged ? ": exchanged labels" : ""));
  }
  const double sd = std::hypot(built.quality.median_sd, built.quality.from_adjusted,
                               survey_sd(built.on_survey->points, noise));
  const CommonLandmarks common =
      common_landmarks(positions_of(built.map), built.on_survey->points, comparison.contradicting);
  if (!contradicts(comparison.rigid.rms, sd, extent_of(common.in_map))) return;
  built.warnings.push_back(joined("the survey contradicts the map, by ",
                                  short_text(comparison.rigid.rms, 3), " m (rms)",
                                  explanation(comparison, common)));
}

void doubt_against_truth(BuiltMap& built) {
  for (const BuiltPath& path : built.paths) {
    if (!path.on_truth) continue;
    if (!contradicts(path.on_truth->rms, path.median_sd, extent_of(path.adjusted))) continue;
    built.warnings.push_back(joined(built.paths.size() > 1 ? path.recording + ": " : std::string(),
                                    "the truth contradicts the path, by ",
                                    short_text(path.on_truth->rms, 3),
                                    " m (rms): is the path's scale wrong, or the truth's unit?"));
  }
}

}  // namespace trussmap
