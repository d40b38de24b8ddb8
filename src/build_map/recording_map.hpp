// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From recordings to a map: every leg is reckoned, handed to the map builder, and sightings that
// contradict the map are kept out.
//
//   for each stop:  reckon on from the last leg's end
//                   gate the stop's sightings against the map
//                   if a leg ends here: arrive at its reference; the stop's other sightings are
//                   routes from that reference
//
// Gate: a sighting of a known landmark whose place differs from where the map has the landmark by
// more than `gate` standard deviations (of the reckoning since the last leg's end, of the sighting,
// and of the map, `map_sd`) is rejected and counted. A landmark sighted from afar enters the map
// when `confirmations` sightings agree on where it is: one misread label cannot place it.
//
// Without a compass the heading is taken from the map on every leg between landmarks that it knows
// (heading_reset.hpp). While the map is young that carries its errors along; therefore the
// recordings are looked at `looks` times, each time building the map anew, with heading and gate
// taken from the map of the look before. A further session begins where it first sights a landmark
// of the map; without a compass its heading there follows from the next landmarks of the map that
// it meets. Sessions with a compass come first. At the end an elastic map is settled in `settle`
// rounds with falling gain (MapBuilder::settle). Where a better map is known (`guide`), one look is
// enough: headings and gate come from there, as do the legs' and routes' directions.
#pragma once

#include "recording/legs.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap {

struct RecordingMapOptions {
  MapBuilderOptions builder{.eta = {.hold_first = false}};
  double min_drive = kDefaultMinDrive;  ///< m
  /// Without a compass headings rest on single sightings; one that comes late while the robot turns
  /// is off by more than its noise. Added to that, rad.
  double bearing_slack = 0.1;
  double gate = kMapGate;                ///< standard deviations; infinity: no gate
  double map_sd = 0.3;                   ///< m per coordinate: how wrong the map itself may be
  int confirmations = 3;                 ///< of a landmark that is only seen from afar
  int looks = 2;                         ///< without a compass; with one, one look is enough
  int settle = 5;                        ///< rounds of settling at the end
  std::map<std::string, Vector2> guide;  ///< m, landmarks as an adjustment has them; may be empty
};

struct RejectedSighting {
  std::string recording;
  double t = 0.0;  ///< s
  std::string landmark;
  double misfit = 0.0;  ///< m, from where the map has the landmark
};

struct RecordingMap {
  LandmarkGraph map;
  std::string method;  ///< which method made it
  int legs = 0;
  int first_sight = 0;
  int refinements = 0;
  int side_sightings = 0;  ///< routes from a stop's reference to what else was seen there
  std::vector<RejectedSighting> rejected;
  std::vector<std::string> unconfirmed;  ///< landmarks sighted, but never often enough
  /// Positions by dead reckoning alone, never corrected: mean over all sightings of a landmark
  /// (of the first recording that saw it), in that recording's frame.
  std::map<std::string, Vector2> dead_reckoned;
};

/// Builds one map from the sessions. Throws InputError where a recording has no
/// sightings or there is no leg, SolveError where a session is tied to nothing.
[[nodiscard]] RecordingMap map_recordings(const std::vector<Recording>& recordings,
                                          const Model& model,
                                          const RecordingMapOptions& options = {});

}  // namespace trussmap
