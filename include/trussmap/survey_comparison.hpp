// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
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
};

/// Needs three common landmarks; with fewer, `landmarks` says how many and the rest is zero.
[[nodiscard]] SurveyComparison compare_with_survey(const LandmarkPositions& map,
                                                   const std::vector<SurveyPoint>& survey);

/// Rigid rms of another set of positions over the same landmarks, m; `leave_out` do not count.
[[nodiscard]] double survey_rms(const LandmarkPositions& map,
                                const std::vector<SurveyPoint>& survey,
                                const std::vector<std::string>& leave_out);

}  // namespace trussmap
