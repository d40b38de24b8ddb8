// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What was measured independently and contradicts what was built: a survey the map, truth a
// path or the robot that made the map. Both have no part in it. Neither has to be wrong, but one of
// the two is.
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/model.hpp"

#include <vector>

namespace trussmap::map_building {

/// Adds to the warnings of a map that has its quality and lies on its survey, with the cheapest
/// explanation that mends it: exchanged labels, a mirrored survey, a scale.
void doubt_against_survey(BuiltMap& built, const Noise& noise);

/// The same of paths and their truth.
void doubt_against_truth(BuiltMap& built);

/// The same of a map of landmarks: truth of its robot, where that saw them.
void doubt_against_truth(BuiltMap& built, const fitting::FitState& fit,
                         const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap::map_building
