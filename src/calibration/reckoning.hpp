// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Dead reckoning by the wheels alone, from a pose at one time of a drive to another time.
#pragma once

#include "odometry/merge.hpp"
#include "odometry/row_reckoner.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

namespace trussmap::calibration {

/// `from` <= `to`, s; times outside of the drive are cut to it.
[[nodiscard]] inline Pose reckoned(const MotionRows& drive, Pose pose, double from, double to) {
  for (const odometry::DriveRow& row : odometry::rows_between(drive, from, to)) {
    pose = compose(pose, odometry::displacement_of(odometry::motion_of(drive, row)));
  }
  return pose;
}

[[nodiscard]] inline Pose pose_of(const TruthRow& row) {
  return {row.x, row.y, row.heading};
}

}  // namespace trussmap::calibration
