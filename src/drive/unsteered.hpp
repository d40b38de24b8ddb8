// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steering effects that were taken into a drive (effects/steering.hpp), taken out again: what the
// wheels, or wheels and gyro, show by the angles as they were read.
#pragma once

#include "drive/body_motion.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>

namespace trussmap {

/// `left` and `right` as they were, where no gyro is taken in; where one is, up to what the changed
/// derivatives do to its weights.
[[nodiscard]] inline MotionRows unsteered(MotionRows drive, const Robot& robot) {
  for (std::size_t row = 0; row < drive.steered.size(); ++row) {
    auto [ahead, turn] = drive.steered[row];
    if (!drive.gyro.empty()) {
      GyroShare& gyro = drive.gyro[row];
      const WheelTravel added = wheel_travel({ahead, 0.0, turn}, robot);
      gyro.left -= added.left;
      gyro.right -= added.right;
      gyro.excess += turn;
      ahead -= gyro.along * turn;
      turn *= 1.0 - gyro.turn;
    }
    add_travel(drive, row, wheel_travel({-ahead, 0.0, -turn}, robot));
  }
  drive.steered.clear();
  return drive;
}

}  // namespace trussmap
