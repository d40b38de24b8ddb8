// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a body moves in a row, whatever wheels it has: the one place where two wheels' travels become
// such a motion, and where a motion becomes what two wheels would show of it.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace trussmap::drive {

/// Of two wheels that are so far apart (m), or of what two wheels there would show.
[[nodiscard]] inline BodyMotion body_motion(const WheelTravel& travel, double wheelbase) {
  return {0.5 * (travel.left + travel.right), 0.0, (travel.right - travel.left) / wheelbase};
}

/// What two wheels that are so far apart show of it, or would if the robot had them.
[[nodiscard]] inline WheelTravel wheel_travel(const BodyMotion& motion, double wheelbase) {
  const double apart = 0.5 * wheelbase * motion.turn;
  return {motion.forward - apart, motion.forward + apart};
}
[[nodiscard]] inline WheelTravel wheel_travel(const BodyMotion& motion, const Robot& robot) {
  return wheel_travel(motion, robot.wheelbase);
}

/// Mean of what they go, m, each counted forwards.
[[nodiscard]] inline double mean_travel(const BodyMotion& motion, const Robot& robot) {
  return std::max(std::abs(motion.forward), 0.5 * robot.wheelbase * std::abs(motion.turn));
}

/// d(forward, turn)/d(left, right) of two wheels, or of those that a drive without shows.
[[nodiscard]] inline Eigen::Matrix2d by_travel(const Robot& robot) {
  const double per_metre = 1.0 / robot.wheelbase;
  return (Eigen::Matrix2d() << 0.5, 0.5, -per_metre, per_metre).finished();
}
[[nodiscard]] inline Eigen::Matrix2d by_travel(const MotionRows& drive, const Robot& robot) {
  return drive.factors ? drive.factors->by_travel : by_travel(robot);
}

/// A motion as the wheels show it, whose factors may have been taken in.
[[nodiscard]] inline BodyMotion as_shown(const MotionRows& drive, const BodyMotion& motion) {
  if (!drive.factors) return motion;
  const Eigen::Vector2d shown = drive.factors->shown * Eigen::Vector2d(motion.forward, motion.turn);
  return {shown[0], motion.sideways, shown[1]};
}

/// Two wheels' own travels in a row, as they are read; of another drive what two wheels would show
/// of its wheels' motion.
[[nodiscard]] inline WheelTravel own_travel(const MotionRows& drive, std::size_t row,
                                            const Robot& robot) {
  return drive.pair.empty() || drive.factors
             ? wheel_travel(as_shown(drive, drive.wheel_motion(row)), robot)
             : drive.pair.at(row);
}

/// Both wheels', m.
[[nodiscard]] inline double total_travel(const WheelTravel& travel) {
  return std::abs(travel.left) + std::abs(travel.right);
}

/// The travels by which two wheels' noise is reckoned, of a unicycle that of two wheels at its
/// wheelbase. With a gyro as both say: of the wheels alone, rows that err towards a larger turn
/// would count less than those that err the other way, and all turns seem larger than the wheels
/// say. But of a wheel that counts backwards the mean is nothing, whatever the gyro says: where
/// both say far less than the wheels went, the wheels.
[[nodiscard]] inline WheelTravel noisy_travel(const MotionRows& drive, std::size_t row,
                                              const Robot& robot) {
  constexpr double kFarLess = 0.5;
  const WheelTravel own = own_travel(drive, row, robot);
  if (drive.gyro.empty()) return own;
  const WheelTravel both = wheel_travel(as_shown(drive, drive.motion(row)), robot);
  return total_travel(both) < kFarLess * total_travel(own) ? own : both;
}

/// The body moves so much more in the row, its wheels too where no gyro is taken in; to the side
/// only where its drive can.
inline void add_motion(MotionRows& drive, std::size_t row, const BodyMotion& more,
                       const Robot& robot) {
  drive.forward[row] += more.forward;
  drive.turn[row] += more.turn;
  if (!drive.sideways.empty()) drive.sideways[row] += more.sideways;
  if (drive.pair.empty() || !drive.gyro.empty()) return;
  const WheelTravel shown = wheel_travel(more, robot);
  drive.pair.left[row] += shown.left;
  drive.pair.right[row] += shown.right;
}

}  // namespace trussmap::drive
