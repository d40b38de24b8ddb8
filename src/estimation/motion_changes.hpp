// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a drive changes between turning on the spot and driving on.
//
// A spin's uncertain turn swings all that is driven after it, which a linearised covariance of the
// whole bends only so far; a pose between the two keeps each segment near its own line. Rests
// belong to whatever goes on around them, and so do spins and drives too short to matter.
#pragma once

#include "estimation/segment_motion.hpp"

#include <vector>

namespace trussmap::estimation {

/// What counts as a motion of its own.
struct LeastMotion {
  double spin = 0.1;   ///< rad
  double drive = 0.1;  ///< m
};

/// Times (ends of rows) at which the rows change from spin to drive or back, ascending.
[[nodiscard]] std::vector<double> motion_changes(const MotionRows& drive,
                                                 const std::vector<SegmentRow>& rows,
                                                 const Robot& robot, const LeastMotion& least);

}  // namespace trussmap::estimation
