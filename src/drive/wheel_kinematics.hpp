// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a robot's columns move its body, one row at a time (DriveKind, robot.hpp); with_wheels does
// so with a whole recording.
#pragma once

#include "drive/steered_motion.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>
#include <string>

#include <Eigen/Core>

namespace trussmap::drive {

/// Of a robot with wheels at its left and at its right that turn as one each.
[[nodiscard]] inline bool has_left_and_right(const Robot& robot) {
  return robot.drive == DriveKind::differential || robot.drive == DriveKind::skid_steer;
}

class WheelKinematics {
 public:
  /// Of any drive but `differential`. Throws std::invalid_argument where the robot has not as many
  /// columns as its drive, or a length that has to be above 0 is not.
  explicit WheelKinematics(const Robot& robot);

  /// So many rows for each of the robot's columns, in their order, all of them 0.
  void prepare(MotionRows& drive, std::size_t rows) const;

  /// From the row's readings its `forward`, `turn`, `sideways` and `by_reading`, the wheel steered
  /// as a change has it. False, and nothing done, where a steering angle leaves the measured wheel
  /// no way ahead.
  [[nodiscard]] bool move(MotionRows& drive, std::size_t row,
                          const SteeringChange& change = {}) const;

 private:
  Robot robot_;
  bool steers_;
  Eigen::MatrixXd matrix_;  ///< 3 x columns, where none steers
};

/// Whether the column is a wheel's or the steering's, and no covariate.
[[nodiscard]] bool is_own_column(const Robot& robot, const std::string& name);

/// Whether a reading is one that a row may hold, m or rad: finite, and not beyond all measure.
[[nodiscard]] bool is_possible_reading(double reading);

}  // namespace trussmap::drive
