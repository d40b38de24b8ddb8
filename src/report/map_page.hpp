// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a map that has been built: before and after, beside the survey where there is one.
#pragma once

#include "plot/map_picture.hpp"
#include "report/page.hpp"
#include "trussmap/survey_comparison.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct BuiltMap {
  MapPicture picture;  ///< map, dead reckoning, survey
  std::string method;
  SurveyComparison survey;          ///< fewer than three landmarks: no survey to speak of
  double rms_dead_reckoning = 0.0;  ///< m
  int legs = 0;
  int first_sight = 0;
  int refinements = 0;
  std::size_t rejected = 0;  ///< sightings kept out
  std::vector<std::string> warnings;
};

}  // namespace trussmap
