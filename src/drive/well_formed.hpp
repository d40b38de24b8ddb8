// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What recording.hpp asks of a recording that a caller has put together.
#pragma once

#include "trussmap/robot.hpp"

#include <vector>

namespace trussmap::drive {

/// How far a time may lie outside a drive, s: times are written in decimals, so that what is
/// reckoned from them misses a start or an end by a rounding error.
[[nodiscard]] double clock_slack(const DriveColumns& drive);

/// Throws std::invalid_argument, naming the recording, the column and the place, where a drive has
/// fewer than two rows or columns that differ in length, times do not increase (of sightings and
/// truth: decrease), a sighting lies outside the drive or has a bearing without a range, a number
/// is not finite that must be, or its two wheels turn it by another wheelbase than this robot's.
void require_well_formed(const DrivenRecording& recording, const Robot& robot);
void require_well_formed(const std::vector<DrivenRecording>& recordings, const Robot& robot);

}  // namespace trussmap::drive
