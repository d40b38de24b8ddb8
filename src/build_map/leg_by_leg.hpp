// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From recordings to a map, leg by leg: the stages that build_map.hpp tells of.
//
//   for each stop:  reckon on from the last leg's end
//                   if a leg ends here: arrive at its reference; the stop's other sightings are
//                   routes from that reference
//
// Guided (adjustments, and maps in a store): what the best fit of everything left out is left out
// here too, and where there is no compass the heading at each stop is that fit's (SessionGuide).
// On its own: what a robot would have had on its way. Sessions with a compass come first.
#pragma once

#include "build_map/sighted_drive.hpp"
#include "trussmap/build_map.hpp"

#include <set>
#include <string>
#include <vector>

namespace trussmap::map_building {

struct LegByLegOptions {
  BuildMapOptions build;       ///< with a method that a map builder has
  const LandmarkGraph& guide;  ///< landmarks with their uncertainties as the best fit has them
  bool guided = true;          ///< else nothing of the best fit is known on the way
  std::set<std::string> stood_on = {};   ///< landmarks that the robot stands on somewhere
  Matrix2 to_map = Matrix2::Identity();  ///< turns the guide's axes into the map's
};

/// For these options, empty.
[[nodiscard]] MapBuilder builder_for(const LegByLegOptions& options);

/// Onto what the builder has. Throws as build_map does.
[[nodiscard]] BuiltMap map_leg_by_leg(const std::vector<SightedDrive>& sessions,
                                      const LegByLegOptions& options, MapBuilder& builder);

}  // namespace trussmap::map_building
