// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steering effects that were taken into a drive (effects/steering.hpp), taken out again: what the
// wheels, or wheels and gyro, show by the angles as they were read.
#pragma once

#include "trussmap/recording.hpp"

#include <array>
#include <cstddef>

namespace trussmap {

/// `left` and `right` as they were, where no gyro is taken in; where one is, up to what the changed
/// derivatives do to its weights.
[[nodiscard]] inline Drive unsteered(Drive drive, double wheelbase) {
  const double half = 0.5 * wheelbase;
  for (std::size_t row = 0; row < drive.steered.size(); ++row) {
    auto [ahead, turn] = drive.steered[row];
    if (!drive.gyro.empty()) {
      GyroShare& gyro = drive.gyro[row];
      gyro.left -= ahead - half * turn;
      gyro.right -= ahead + half * turn;
      gyro.excess += turn;
      ahead -= gyro.along * turn;
      turn *= 1.0 - gyro.turn;
    }
    drive.left[row] -= ahead - half * turn;
    drive.right[row] -= ahead + half * turn;
  }
  drive.steered.clear();
  return drive;
}

}  // namespace trussmap
