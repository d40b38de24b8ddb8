// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks that a map and a survey have in common.
#pragma once

#include "trussmap/survey_comparison.hpp"

#include <string>
#include <vector>

namespace trussmap::map {

struct CommonLandmarks {
  std::vector<std::string> names;
  std::vector<Vector2> in_map;    ///< m, one per name
  std::vector<Vector2> surveyed;  ///< m
};

/// In the survey's order, but for those that are to be left out.
[[nodiscard]] CommonLandmarks common_landmarks(const LandmarkPositions& map,
                                               const std::vector<SurveyPoint>& survey,
                                               const std::vector<std::string>& leave_out);

}  // namespace trussmap::map
