// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stops and legs: how a recording falls into drives between landmarks.
//
//   stop   the sightings that share a time, ranges alone apart; its reference is the landmark the
//   robot stands on,
//          else the nearest one it sees
//   leg    the drive between two stops with different references that are at least `min_drive` of
//          driven path apart: from each leg's end, the first stop that qualifies ends the next
//
//   t ----S1-------S2-S3--------S4----->      S3 is nearer than min_drive to S2, or has the same
//          \--leg--/ \---leg----/             reference: a sighting in between
#pragma once

#include "trussmap/robot.hpp"

#include <vector>

namespace trussmap::drive {

struct Stop {
  double t = 0.0;         ///< s
  std::size_t first = 0;  ///< its sightings are first ... first + count - 1, and ranges among them
  std::size_t count = 0;
  std::size_t reference = 0;  ///< the reference landmark's sighting
};

struct Leg {
  std::size_t from = 0;  ///< stop
  std::size_t to = 0;    ///< stop
};

/// Stops in order of time. Sightings must be in order of time.
[[nodiscard]] std::vector<Stop> stops_of(const std::vector<Sighting>& sightings);

/// Driven path of the axle's centre from the drive's start to the end of each row, m.
[[nodiscard]] std::vector<double> driven_path(const MotionRows& drive);

/// The path at time t, linear within a row. `path` is driven_path(drive), or whatever else grows
/// from 0 at the drive's start and is given at the end of each row.
[[nodiscard]] double path_at(const DriveColumns& drive, const std::vector<double>& path, double t);

/// Legs in order. A recording without sightings has none.
[[nodiscard]] std::vector<Leg> legs_of(const DrivenRecording& recording,
                                       const std::vector<Stop>& stops,
                                       double min_drive = kDefaultMinDrive);

/// Whether a leg of this number is held out, of which `share` in [0, 1) are: legs are taken in
/// blocks of five, and the blocks held out are spread evenly.
[[nodiscard]] bool is_held_out(std::size_t leg, double share);

}  // namespace trussmap::drive
