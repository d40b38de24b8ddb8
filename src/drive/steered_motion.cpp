// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/steered_motion.hpp"

#include <cmath>

namespace trussmap::drive {
namespace {

/// Of a tricycle's one wheel.
SteeredMotion by_steered_wheel(double length, double left, double travel, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double z = left / length;
  SteeredMotion body;
  body.by_reading = {Eigen::Vector3d(c + z * s, 0.0, s / length),
                     Eigen::Vector3d(travel * (z * c - s), 0.0, travel * c / length)};
  body.motion = travel * body.by_reading[0];
  return body;
}

}  // namespace

SteeredMotion steered_motion(const Robot& robot, double travel, double angle,
                             const SteeringChange& change) {
  const double at = angle + change.angle;
  const double left = robot.steer_left + change.steer_left;
  if (robot.drive == DriveKind::tricycle) {
    return by_steered_wheel(robot.length, left, travel, at);
  }
  SteeredMotion body;
  const double s = std::sin(at);
  // All turn about a point on the rear axle, radius over sine of the angle to the left.
  const double radius = robot.length * std::cos(at) + left * s;
  const double y = robot.wheel_left + change.wheel_left;
  body.possible = radius > 0.0 && radius > y * s;
  if (!body.possible && travel == 0.0) {
    body.possible = true;
    body.by_reading.fill(Eigen::Vector3d::Zero());
    return body;
  }
  const double k = s / radius;
  const double k_by_angle = robot.length / (radius * radius);
  const double share = 1.0 / (1.0 - y * k);  // of the centre's way in the wheel's
  const double share_by_angle = share * share * y * k_by_angle;
  body.by_reading = {Eigen::Vector3d(share, 0.0, share * k),
                     Eigen::Vector3d(travel * share_by_angle, 0.0,
                                     travel * (share_by_angle * k + share * k_by_angle))};
  body.motion = travel * body.by_reading[0];
  return body;
}

}  // namespace trussmap::drive
