// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that stands on a code on the floor reads its own place in the code's axes, (dx, dy), and
// the code's yaw. What its camera saw is the code in the robot's axes, and there the errors of
// place and yaw are independent:
//
//   code_from_robot = -R(yaw) (dx, dy)
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

namespace trussmap::recording {

/// m, ahead and to the left of a robot that stands on the landmark; zero without dx and dy.
[[nodiscard]] inline Vector2 code_from_robot(const Sighting& sighting) {
  if (sighting.dx != sighting.dx) return Vector2::Zero();
  return -(rotation(sighting.yaw) * Vector2(sighting.dx, sighting.dy));
}

/// Sets dx and dy such that at the sighting's yaw the code is there.
inline void place_by_code(const Vector2& code, Sighting& sighting) {
  const Vector2 robot = -(rotation(-sighting.yaw) * code);
  sighting.dx = robot.x();
  sighting.dy = robot.y();
}

}  // namespace trussmap::recording
