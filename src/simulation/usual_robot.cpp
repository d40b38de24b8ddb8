// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace trussmap {
namespace {

using std::numbers::pi;

double usual_length(DriveKind drive) {
  switch (drive) {
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      return 0.5;
    case DriveKind::mecanum:
      return 0.3;
    case DriveKind::omni3:
    case DriveKind::wheels:
      return 0.2;
    case DriveKind::differential:
    case DriveKind::unicycle:
    case DriveKind::skid_steer:
      break;
  }
  return 0.0;
}

std::vector<std::string> usual_columns(DriveKind drive) {
  switch (drive) {
    case DriveKind::differential:
      break;
    case DriveKind::unicycle:
      return {"travel", "turn"};
    case DriveKind::skid_steer:
      return {"front_left", "rear_left", "front_right", "rear_right"};
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      return {"wheel", "steer"};
    case DriveKind::omni3:
      return {"wheel1", "wheel2", "wheel3"};
    case DriveKind::mecanum:
      return {"front_left", "front_right", "rear_left", "rear_right"};
    case DriveKind::wheels:
      return {"wheel1", "wheel2", "wheel3", "wheel4"};
  }
  return {};
}

}  // namespace

Robot usual_robot(DriveKind drive, double wheelbase, double length) {
  Robot robot;
  robot.drive = drive;
  robot.columns = usual_columns(drive);
  robot.length = length > 0.0 ? length : usual_length(drive);
  if (wheelbase > 0.0) robot.wheelbase = wheelbase;
  const bool has_wheelbase = drive == DriveKind::differential || drive == DriveKind::unicycle ||
                             drive == DriveKind::skid_steer || drive == DriveKind::mecanum;
  if (drive == DriveKind::wheels) {
    // Front left, front right, rear left, rear right.
    const double radius = robot.length;
    for (const double at : {0.25 * pi, -0.25 * pi, 0.75 * pi, -0.75 * pi}) {
      const double direction = at > 0.0 ? at - 0.5 * pi : at + 0.5 * pi;
      robot.places.push_back({radius * std::cos(at), radius * std::sin(at), direction, 0.0});
    }
    robot.matrix = wheel_matrix(robot.places);
    robot.length = 0.0;
    robot.wheelbase = Robot().wheelbase;
  } else if (!has_wheelbase) {
    // Of no meaning then but for how turns are written as travels of two wheels.
    robot.wheelbase = robot.length;
  }
  return robot;
}

}  // namespace trussmap
