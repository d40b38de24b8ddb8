// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What dead reckoning makes of the landmarks, never corrected: what a map is compared with.
#pragma once

#include "build_map/sighted_drive.hpp"
#include "trussmap/survey_comparison.hpp"

#include <vector>

namespace trussmap::map_building {

struct ReckonedMap {
  /// Mean over all sightings of a landmark, of the first session that saw it, in that session's
  /// frame.
  LandmarkPositions places;
  /// Of each loop from a landmark back to it: how far it misses its start, as a share of the way.
  std::vector<double> misclosures;
};

/// By wheels and compass alone. Sightings that were left out have no part in the loops.
[[nodiscard]] ReckonedMap reckoned_map(const std::vector<SightedDrive>& sessions);

}  // namespace trussmap::map_building
