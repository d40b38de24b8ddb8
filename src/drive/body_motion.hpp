// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a body moves in a row, whatever wheels it has: the one place where two wheels' travels become
// such a motion, and where a motion becomes what two wheels would show of it.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>

namespace trussmap {

/// Along its own axes, evenly as it turns.
struct BodyMotion {
  double forward = 0.0;   ///< m
  double sideways = 0.0;  ///< m to the left
  double turn = 0.0;      ///< rad

  friend BodyMotion operator*(double share, const BodyMotion& of) {
    return {share * of.forward, share * of.sideways, share * of.turn};
  }
};

/// Of two wheels that are so far apart (m), or of what two wheels there would show.
[[nodiscard]] inline BodyMotion body_motion(const WheelTravel& travel, double wheelbase,
                                            double sideways = 0.0) {
  return {0.5 * (travel.left + travel.right), sideways, (travel.right - travel.left) / wheelbase};
}
[[nodiscard]] inline BodyMotion body_motion(const WheelTravel& travel, const Robot& robot,
                                            double sideways = 0.0) {
  return body_motion(travel, robot.wheelbase, sideways);
}

/// What two wheels of this robot show of it, or would if it had them.
[[nodiscard]] inline WheelTravel wheel_travel(const BodyMotion& motion, const Robot& robot) {
  const double apart = 0.5 * robot.wheelbase * motion.turn;
  return {motion.forward - apart, motion.forward + apart};
}

/// Of a whole row, by the wheels or by wheels and gyro together.
[[nodiscard]] inline BodyMotion body_motion(const MotionRows& drive, std::size_t row,
                                            const Robot& robot) {
  return body_motion({drive.left[row], drive.right[row]}, robot, drive.slip(row));
}

/// Two wheels travel so much more in the row.
inline void add_travel(MotionRows& drive, std::size_t row, const WheelTravel& more) {
  drive.left[row] += more.left;
  drive.right[row] += more.right;
}

/// The body moves so much more in the row; to the side only where its drive can.
inline void add_motion(MotionRows& drive, std::size_t row, const BodyMotion& more,
                       const Robot& robot) {
  add_travel(drive, row, {more.forward, more.forward});
  add_travel(drive, row, wheel_travel({0.0, 0.0, more.turn}, robot));
  if (!drive.sideways.empty()) drive.sideways[row] += more.sideways;
}

}  // namespace trussmap
