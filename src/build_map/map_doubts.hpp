// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How good a map is: its figures, and in words what speaks against it.
#pragma once

#include "build_map/map_fit.hpp"
#include "build_map/reckoned_map.hpp"
#include "trussmap/build_map.hpp"

#include <string>
#include <vector>

namespace trussmap::map_building {

/// Figures of the built map, which has its positions. `best` is the fit that it rests on.
[[nodiscard]] MapQuality quality_of(const BuiltMap& built, const MapFitState& best,
                                    const ReckonedMap& reckoned);

/// Rms distance of places from their middle, m.
[[nodiscard]] double extent_of(const std::vector<Vector2>& places);
[[nodiscard]] double extent_of(const LandmarkGraph& map);

/// "a, b, c and 4 more".
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

/// Fills in the warnings and notes; the map has its quality.
void doubt(BuiltMap& built, const MapFitState& best, const std::vector<DrivenRecording>& recordings,
           const Model& model);

}  // namespace trussmap::map_building
