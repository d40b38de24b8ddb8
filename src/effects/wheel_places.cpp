// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/wheel_places.hpp"

#include <cmath>
#include <numbers>

namespace trussmap::effects {
namespace {

using std::numbers::pi;

/// As many on either side, one behind the other, a wheel's width of the wheelbase apart.
std::vector<WheelPlace> in_two_rows(const Robot& robot, std::size_t count) {
  std::vector<WheelPlace> places;
  const std::size_t side = count / 2;
  for (std::size_t k = 0; k < count; ++k) {
    const double behind = static_cast<double>(k % side) - 0.5 * static_cast<double>(side - 1);
    const double y = k < side ? 0.5 * robot.wheelbase : -0.5 * robot.wheelbase;
    places.push_back({-0.8 * robot.wheelbase * behind, y, 0.0, 0.0});
  }
  return places;
}

}  // namespace

std::vector<WheelPlace> wheel_places(const Robot& robot) {
  const double front = 0.5 * robot.length;
  const double side = 0.5 * robot.wheelbase;
  std::vector<WheelPlace> places;
  switch (robot.drive) {
    case DriveKind::differential:
      return in_two_rows(robot, 2);
    case DriveKind::skid_steer:
      return in_two_rows(robot, robot.columns.size());
    case DriveKind::tricycle:
      return {{robot.length, robot.steer_left, 0.0, 0.0}};
    case DriveKind::ackermann:
      return {{0.0, robot.wheel_left, 0.0, 0.0}};
    case DriveKind::omni3:
      for (const double at : {-pi / 3.0, pi / 3.0, pi}) {
        places.push_back(
            {robot.length * std::cos(at), robot.length * std::sin(at), at - 0.5 * pi, 0.0});
      }
      return places;
    case DriveKind::mecanum:
      return {{front, side, 0.0, -0.25 * pi},
              {front, -side, 0.0, 0.25 * pi},
              {-front, side, 0.0, 0.25 * pi},
              {-front, -side, 0.0, -0.25 * pi}};
    case DriveKind::unicycle:
    case DriveKind::wheels:
      break;
  }
  return robot.places;
}

}  // namespace trussmap::effects
