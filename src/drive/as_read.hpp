// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects that were taken into a drive (effects/steering.hpp, effects/wheel_factors.hpp), taken out
// again: what the wheels, or wheels and gyro, show by angles and travels as they were read.
#pragma once

#include "drive/body_motion.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>

namespace trussmap::drive {

/// Whether anything was taken in.
[[nodiscard]] inline bool is_as_read(const MotionRows& drive) {
  return drive.steered.empty() && !drive.factors;
}

/// The wheels' motion in a row is so much more than the drive says; the gyro's turn stays.
inline void move_wheels(MotionRows& drive, std::size_t row, BodyMotion more) {
  if (!drive.gyro.empty()) {
    GyroShare& gyro = drive.gyro[row];
    gyro.wheels = gyro.wheels + more;
    gyro.excess -= more.turn;
    more.forward -= gyro.along * more.turn;
    more.turn *= 1.0 - gyro.turn;
  }
  drive.forward[row] += more.forward;
  drive.turn[row] += more.turn;
}

/// `forward` and `turn` as they were, where no gyro is taken in; where one is, up to what the
/// effects do to its weights.
[[nodiscard]] inline MotionRows as_read(MotionRows drive, const Robot& robot) {
  for (std::size_t row = 0; row < drive.steered.size(); ++row) {
    const auto [ahead, turn] = drive.steered[row];
    move_wheels(drive, row, {-ahead, 0.0, -turn});
  }
  drive.steered.clear();
  for (std::size_t row = 0; row < drive.rows() && drive.factors; ++row) {
    const BodyMotion is = drive.wheel_motion(row);
    const BodyMotion shown = as_shown(drive, is);
    move_wheels(drive, row, shown + -1.0 * is);
    if (drive.pair.empty()) continue;
    const WheelTravel own = wheel_travel(shown, robot);
    drive.pair.left[row] = own.left;
    drive.pair.right[row] = own.right;
  }
  drive.factors.reset();
  return drive;
}

}  // namespace trussmap::drive
