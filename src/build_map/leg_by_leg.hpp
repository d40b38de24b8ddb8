// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From recordings to a map, leg by leg: the stages that build_map.hpp tells of.
//
//   for each stop:  reckon on from the last leg's end
//                   gate the stop's sightings against the map
//                   if a leg ends here: arrive at its reference; the stop's other sightings are
//                   routes from that reference
//
// Sessions with a compass come first. At the end an elastic map is settled in rounds with falling
// gain. Where a better map is known (the guide), one look is enough: headings and gate come from
// there, as do the legs' and routes' directions.
#pragma once

#include "build_map/sighted_drive.hpp"
#include "trussmap/build_map.hpp"

#include <vector>

namespace trussmap {

struct LegByLegOptions {
  BuildMapOptions build;    ///< with a method that a map builder has
  double gate = 0.0;        ///< standard deviations; infinity: no gate
  LandmarkPositions guide;  ///< landmarks as an adjustment has them; may be empty
};

/// Throws as build_map does.
[[nodiscard]] BuiltMap map_leg_by_leg(const std::vector<SightedDrive>& sessions,
                                      const LegByLegOptions& options);

}  // namespace trussmap
