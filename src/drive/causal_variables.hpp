// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a shape may speak of, as far as a robot knows it when a row ends.
//
// Everything is as row_variables.hpp has it but the rates. There they are means over the second
// about a row, within one kind of motion; here over the second up to the row's end, and so half a
// second late while the motion changes. At the end of a row they are the row's own.
//
//   row_variables     . . . [ . . . row . . . ] . . .
//   here          [ . . . . . . . . row ]
#pragma once

#include "drive/body_motion.hpp"
#include "drive/row_variables.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace trussmap::drive {

/// One row, by the rows before it; the names are those of row_variables.hpp.
struct CausalRow {
  MotionKind kind = MotionKind::standing;
  double speed = 0.0;         ///< m/s
  double turn_rate = 0.0;     ///< rad/s
  double acceleration = 0.0;  ///< m/s^2
  double curvature = 0.0;     ///< 1/m
  double arc_angle = 0.0;     ///< rad
  double spin_angle = 0.0;    ///< rad
  double session = 0.0;       ///< the first
  double starts = 0.0, spins = 0.0, reverses_left = 0.0, reverses_right = 0.0;
  double t = 0.0, t_end = 0.0;                ///< s since the first row began: middle, end
  double distance = 0.0, distance_end = 0.0;  ///< m
};

/// What a row's wheels show.
struct WheelWay {
  WheelTravel travel;     ///< as own_travel
  double sideways = 0.0;  ///< m to the left
};

class CausalVariables {
 public:
  /// What this row, of `duration` s, would be as the next one: the kind of motion by the wheels
  /// alone, rates and distance by what wheels and gyro say together.
  [[nodiscard]] CausalRow next(const WheelWay& wheels, const BodyMotion& together,
                               double duration) const;
  /// Takes it in.
  void take(const WheelWay& wheels, const BodyMotion& together, double duration);

 private:
  struct Past {
    MotionKind kind = MotionKind::standing;
    double begin = 0.0, middle = 0.0;      ///< s
    double travelled = 0.0, turned = 0.0;  ///< m, rad: sums up to its beginning
    double speed = 0.0;                    ///< m/s
  };
  /// The first row of the window that ends with a row of this kind and middle.
  [[nodiscard]] std::size_t window(MotionKind kind, double middle) const;

  std::vector<Past> past_;  ///< from first_ on: the last second of one kind of motion
  std::size_t first_ = 0;   ///< those before it are forgotten
  std::optional<MotionKind> kind_;
  double t_ = 0.0;           ///< s
  double travelled_ = 0.0;   ///< m, signed
  double turned_ = 0.0;      ///< rad
  double distance_ = 0.0;    ///< m
  double sense_left_ = 0.0;  ///< of the wheel's last motion: 1, -1; 0 before any
  double sense_right_ = 0.0;
};

}  // namespace trussmap::drive
