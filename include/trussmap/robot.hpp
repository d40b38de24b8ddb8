// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot's wheels: where they are, and how they move its body.
#pragma once

#include "trussmap/recording.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

/// Of two wheels over a row, or over an arc.
struct WheelTravel {
  double left = 0.0;   ///< m, signed
  double right = 0.0;  ///< m, signed
};

/// How wheels move the body over a row: (f, s, a) = forward, to the left [m], turn [rad] of the
/// body's reference point, from the wheels' travels w [m] and the steering angle b [rad, left
/// positive, mean over the row].
///
///   differential   w = left, right             f = (w1 + w2)/2, a = (w2 - w1)/wheelbase
///   skid_steer     w = left ones, right ones   the same of their means; `wheelbase` is the
///                                              effective one
///   tricycle       w = of the steered wheel    f = w cos b, a = w sin b/length
///   ackermann      w = of a rear wheel         f = w/(1 - y k), a = f k, k = tan(b)/length, with
///                                              the wheel y to the left of the rear axle's centre
///   omni3          w = front right, front      f = (w2 - w1)/sqrt 3, s = (2 w3 - w1 - w2)/3,
///                  left, rear                  a = -(w1 + w2 + w3)/(3 length); 120 degrees apart,
///                                              w positive where it turns the robot clockwise
///   mecanum        w = front left, front       f = (w1 + w2 + w3 + w4)/4,
///                  right, rear left, rear      s = (-w1 + w2 + w3 - w4)/4,
///                  right                       a = (-w1 + w2 - w3 + w4)/(2 (wheelbase + length))
///   wheels         w = any columns             (f, s, a) = matrix w
enum class DriveKind { differential, skid_steer, tricycle, ackermann, omni3, mecanum, wheels };

[[nodiscard]] std::string_view name_of(DriveKind drive);
/// Throws std::invalid_argument, listing all names, where there is none of this name.
[[nodiscard]] DriveKind drive_named(std::string_view name);

/// A wheel of the drive `wheels`: it shows the way of its place along its own direction, and lets
/// rollers, where it has some, slip along theirs.
struct WheelPlace {
  double x = 0.0;          ///< m ahead of the body's reference point
  double y = 0.0;          ///< m to its left
  double direction = 0.0;  ///< rad from ahead to where it rolls, left positive
  double roller = 0.0;     ///< rad from the direction to the rollers' axes; omni wheels: 0
};

struct Robot {
  double wheelbase = 0.34;       ///< m, nominal
  bool wheelbase_stated = true;  ///< else a model file left it out, and it is the default
  DriveKind drive = DriveKind::differential;
  std::vector<std::string> columns = {};  ///< of drive.csv; empty of two wheels: left, right
  /// m: tricycle and ackermann from the rear axle to the steered wheel, omni3 from the centre to a
  /// wheel, mecanum from the front axle to the rear one.
  double length = 0.0;
  double wheel_left = 0.0;              ///< m, ackermann: the measured wheel's y
  std::vector<WheelPlace> places = {};  ///< of `wheels`; empty: the matrix is given
  Eigen::MatrixXd matrix = {};          ///< of `wheels`: 3 x columns
};

/// The matrix that wheels at these places have: of least squares where more than needed. Wheels
/// that show no way to the side leave s = 0. Throws std::invalid_argument where they do not show
/// forward and turn, or where they mix one of them with s.
[[nodiscard]] Eigen::MatrixXd wheel_matrix(const std::vector<WheelPlace>& places);

/// The recording with its robot's wheels taken in: `left`, `right`, `sideways` and `wheels` of its
/// drive from the columns that the robot names, which stay covariates. Unchanged of two wheels
/// named left and right. Throws InputError where a column is not there, a reading is impossible, or
/// where the drive has no wheels at all.
[[nodiscard]] Recording with_wheels(Recording recording, const Robot& robot);

}  // namespace trussmap
