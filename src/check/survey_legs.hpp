// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From one surveyed landmark to another: as the survey has it, and as it was driven or seen; and
// from fix to fix.
#pragma once

#include "check/track.hpp"

#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace trussmap::check {

struct SurveyLeg {
  std::string_view from;
  std::string_view to;
  Vector2 measured = Vector2::Zero();  ///< m, track's axes
  Vector2 surveyed = Vector2::Zero();  ///< by the survey, or by fixes
  double t = 0.0;                      ///< s, of its end
};

using SurveyPlaces = std::map<std::string_view, Vector2>;

[[nodiscard]] std::set<std::string_view> sighted_landmarks(const DrivenRecording& recording);
/// Of the landmarks that were sighted.
[[nodiscard]] SurveyPlaces surveyed_places(const DrivenRecording& recording);

/// From stop to stop on two of them.
[[nodiscard]] std::vector<SurveyLeg> legs_by_way(const DrivenRecording& recording,
                                                 const SurveyPlaces& places, const Track& track);
/// Between two that are seen at one time.
[[nodiscard]] std::vector<SurveyLeg> legs_by_views(const DrivenRecording& recording,
                                                   const SurveyPlaces& places, const Track& track,
                                                   double bearing_unit);
/// From fix to fix, five metres of the way apart.
[[nodiscard]] std::vector<SurveyLeg> legs_by_fixes(const DrivenRecording& recording,
                                                   const Track& track);

}  // namespace trussmap::check
