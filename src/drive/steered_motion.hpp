// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Kinematics of a drive with a steered wheel: tricycle and ackermann (DriveKind, robot.hpp).
#pragma once

#include "trussmap/robot.hpp"

#include <array>

#include <Eigen/Core>

namespace trussmap::drive {

[[nodiscard]] inline bool has_steering(const Robot& robot) {
  return robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann;
}

/// What steering effects add in a row.
struct SteeringChange {
  double angle = 0.0;       ///< rad to the left, beside what is read
  double gain = 0.0;        ///< rad per rad read, of that
  double wheel_left = 0.0;  ///< m, ackermann: the measured wheel stands so much further left
  double steer_left = 0.0;  ///< m, and the steered one
};

/// How a robot moves in a row by the travel of the wheel that is measured [m] and the angle at
/// which its steered wheel stands [rad].
struct SteeredMotion {
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< forward, sideways [m], turn [rad]
  std::array<Eigen::Vector3d, 2> by_reading;         ///< by travel and by angle
  bool possible = true;                              ///< the measured wheel has a way ahead
};
/// Of a robot that has steering. A wheel that stands moves nothing, wherever it points.
[[nodiscard]] SteeredMotion steered_motion(const Robot& robot, double travel, double angle,
                                           const SteeringChange& change = {});

}  // namespace trussmap::drive
