// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// How far a map is from an independent survey of its landmarks.
//
// The map's frame is arbitrary, so it is first laid over the survey: rotation and translation
// (rigid), or with a scale as well (similarity), by least squares. A landmark that lies far off
// while the others agree contradicts the survey (an exchanged label, a moved landmark) and is left
// out of the fit and of the figures, and named.
//
// Found by least median of squares over the alignments that each pair of landmarks gives; a
// landmark contradicts if it is off by more than 10 times the others' median and 10 times their
// rms. At most a third can: beyond that the map is simply bad, and all count.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap {

using LandmarkPositions = std::map<std::string, Vector2>;  // m

[[nodiscard]] LandmarkPositions positions_of(const LandmarkGraph& map);

struct SurveyComparison {
  int landmarks = 0;     ///< that count: in the map and in the survey, not contradicting
  Alignment rigid;       ///< map onto survey; rigid.rms is the figure, m
  Alignment similarity;  ///< the same with a scale
  double rms_all = 0.0;  ///< m, rigid, with the contradicting ones
  std::vector<std::string> contradicting;                      ///< names, in order
  std::vector<std::pair<std::string, std::string>> exchanged;  ///< each lies where the other should

  /// Whether the scale means anything: where none makes them alike, the best one is that of a map
  /// shrunk to a point.
  [[nodiscard]] bool has_scale() const {
    return (similarity.scale > 0.5 && similarity.scale < 2.0) || similarity.rms < 0.5 * rigid.rms;
  }
};

/// Needs three common landmarks; with fewer, `landmarks` says how many and the rest is zero.
[[nodiscard]] SurveyComparison compare_with_survey(const LandmarkPositions& map,
                                                   const std::vector<SurveyPoint>& survey);

/// Rigid rms of another set of positions over the same landmarks, m; `leave_out` do not count.
[[nodiscard]] double survey_rms(const LandmarkPositions& map,
                                const std::vector<SurveyPoint>& survey,
                                const std::vector<std::string>& leave_out);

// ----------------------------------------
// Errors as the elastic paper has them (Golfarelli, Maio & Rizzi, 1998, section 4).

/// How a map is compared with the truth.
enum class Laid {
  as_it_is,  ///< both have the same axes and the same first landmark, which does not count
  aligned    ///< after the best rotation and translation of the landmarks; all count
};

struct MapErrors {
  double stretch = 0.0;            ///< sigma: mean over routes of |s_map - s|/s
  double orientation = 0.0;        ///< rho: mean over routes of |theta_map - theta|, rad
  std::optional<double> position;  ///< m, mean distance of landmarks from the truth, where known
  int routes = 0;                  ///< that count: both ends in the truth, and apart there
};

/// What turns and moves the map so that its landmarks lie best on the truth's. Throws
/// std::invalid_argument where they have fewer than two in common.
[[nodiscard]] Alignment onto_truth(const LandmarkGraph& map, const LandmarkPositions& truth);

/// The map laid so. Throws likewise.
[[nodiscard]] LandmarkGraph laid_over(const LandmarkGraph& map, const LandmarkPositions& truth);

/// Errors of a map's routes and landmarks as they lie in it. Landmarks that the truth lacks do not
/// count. Throws std::invalid_argument where fewer than two do.
[[nodiscard]] MapErrors map_errors(const LandmarkGraph& map, const LandmarkPositions& truth,
                                   Laid laid = Laid::as_it_is);

}  // namespace trussmap
