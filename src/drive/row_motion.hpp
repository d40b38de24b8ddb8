// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One row as its wheels show it, the gyro beside them, and what an error of each wheel does to the
// body: what the physics of effects (effects/channel_physics.hpp) speak of.
#pragma once

#include "drive/body_motion.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace trussmap::drive {

struct RowMotion {
  BodyMotion body;            ///< as the wheels show it, or wheels and gyro together
  double wheelbase = 0.0;     ///< m, of a left and a right wheel
  double length = 0.0;        ///< m, of a robot that steers
  bool front = false;         ///< its measured wheel is the steered one
  double duration = 0.0;      ///< s
  double gyro_turn = 0.0;     ///< rad
  double gyro_along = 0.0;    ///< as GyroShare::along
  double gyro_lateral = 0.0;  ///< as GyroShare::lateral
  double gyro_share = 0.0;    ///< as GyroShare::turn
  bool gyro_reads = false;
  const Eigen::Matrix2d* shown = nullptr;  ///< as WheelFactors::shown, of what is taken in
  const std::vector<WheelColumn>* wheels = nullptr;  ///< of the drive, where it has other wheels
  std::size_t row = 0;                               ///< of the drive

  /// Other wheels than two, of this drive.
  void set_wheels(const MotionRows& drive, std::size_t number) {
    wheels = drive.wheels.empty() ? nullptr : &drive.wheels;
    row = number;
  }
};

[[nodiscard]] inline RowMotion row_motion(const BodyMotion& body, double duration,
                                          const Robot& robot) {
  RowMotion row;
  row.body = body;
  row.wheelbase = robot.wheelbase;
  row.length = robot.length;
  row.front = robot.drive == DriveKind::tricycle;
  row.duration = duration;
  return row;
}

/// A row as its wheels show it, or wheels and gyro together.
[[nodiscard]] inline RowMotion shown_motion(const MotionRows& drive, std::size_t row,
                                            const Robot& robot) {
  RowMotion shown = row_motion(drive.motion(row), drive.duration(row), robot);
  shown.set_wheels(drive, row);
  return shown;
}

/// Wheels and gyro each for itself.
[[nodiscard]] inline RowMotion row_motion(const GyroShare& gyro, double duration,
                                          const Robot& robot) {
  RowMotion row = row_motion(gyro.wheels, duration, robot);
  row.gyro_turn = row.body.turn + gyro.excess;
  row.gyro_along = gyro.along;
  row.gyro_lateral = gyro.lateral;
  row.gyro_share = gyro.turn;
  row.gyro_reads = std::isfinite(gyro.variance);
  return row;
}
/// The same of a drive's row, whether or not the gyro was taken in; as it was read, where factors
/// of its wheels were.
[[nodiscard]] inline RowMotion row_motion(const MotionRows& drive, std::size_t row,
                                          const Robot& robot) {
  RowMotion motion = drive.gyro.empty() ? shown_motion(drive, row, robot)
                                        : row_motion(drive.gyro[row], drive.duration(row), robot);
  motion.set_wheels(drive, row);
  motion.body = as_shown(drive, motion.body);
  if (drive.factors) motion.shown = &drive.factors->shown;
  return motion;
}

}  // namespace trussmap::drive
