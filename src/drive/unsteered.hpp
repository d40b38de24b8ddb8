// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steering effects that were taken into a drive (effects/steering.hpp), taken out again: what the
// wheels, or wheels and gyro, show by the angles as they were read.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>

namespace trussmap::drive {

/// `forward` and `turn` as they were, where no gyro is taken in; where one is, up to what the
/// changed derivatives do to its weights.
[[nodiscard]] inline MotionRows unsteered(MotionRows drive) {
  for (std::size_t row = 0; row < drive.steered.size(); ++row) {
    auto [ahead, turn] = drive.steered[row];
    if (!drive.gyro.empty()) {
      GyroShare& gyro = drive.gyro[row];
      gyro.wheels.forward -= ahead;
      gyro.wheels.turn -= turn;
      gyro.excess += turn;
      ahead -= gyro.along * turn;
      turn *= 1.0 - gyro.turn;
    }
    drive.forward[row] -= ahead;
    drive.turn[row] -= turn;
  }
  drive.steered.clear();
  return drive;
}

}  // namespace trussmap::drive
