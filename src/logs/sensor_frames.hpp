// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a robot's sensors sit, by the transforms of a log: from the robot's base to the frame that
// a message says it is of.
//
//   fixes              the message's frame                        antenna
//   range and bearing  the map's `sensor`, or the message's       sensor
//   truth along /tf    its child, where that is not the base      tracked
//
// Landmarks by their position are seen from the base already (seen_landmarks.hpp).
#pragma once

#include "logs/gathered_log.hpp"
#include "trussmap/robot.hpp"

#include <string>
#include <vector>

namespace trussmap::logs {

struct MountedByFrames {
  Mountings mounted;
  std::vector<std::string> told;  ///< of what was found, in words
};

/// What the model states stays. Nothing of frames that are not joined to the base.
[[nodiscard]] MountedByFrames mounted_by_frames(const LogMap& map, const GatheredLog& log);

/// Frames that may be the robot's base.
[[nodiscard]] std::vector<std::string> base_frames(const LogMap& map);

}  // namespace trussmap::logs
