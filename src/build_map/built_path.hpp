// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is built of recordings without landmarks: where the robot drove.
//
//   fit --> adjusted path, its standard errors where something was measured
//       --> fixes and loops beside it: how far off, and which were left out
//   dead reckoning, never corrected, laid on the adjusted path; both laid on the truth, if any
#pragma once

#include "build_map/map_fit.hpp"
#include "fit/cleared_recording.hpp"
#include "trussmap/build_map.hpp"

#include <vector>

namespace trussmap::map_building {

/// One per recording; `believed` are the recordings freed from the effects that the user's model
/// states. The fit has laid its paths.
[[nodiscard]] std::vector<BuiltPath> paths_of(
    const MapFitState& best, const std::vector<DrivenRecording>& recordings,
    const std::vector<fitting::ClearedRecording>& believed, const Model& model);

/// Figures of the paths together.
[[nodiscard]] MapQuality quality_of(const std::vector<BuiltPath>& paths, const MapFitState& best);

}  // namespace trussmap::map_building
