// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A robot's wheels: where they are, and how they move its body.
#pragma once

#include "trussmap/recording.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

/// Of two wheels over a row, or over an arc.
struct WheelTravel {
  double left = 0.0;   ///< m, signed
  double right = 0.0;  ///< m, signed

  friend WheelTravel operator*(double share, const WheelTravel& of) {
    return {share * of.left, share * of.right};
  }
};

/// Of a body over a row, along its own axes, evenly as it turns.
struct BodyMotion {
  double forward = 0.0;   ///< m
  double sideways = 0.0;  ///< m to the left
  double turn = 0.0;      ///< rad to the left

  friend BodyMotion operator*(double share, const BodyMotion& of) {
    return {share * of.forward, share * of.sideways, share * of.turn};
  }
  friend BodyMotion operator+(const BodyMotion& a, const BodyMotion& b) {
    return {a.forward + b.forward, a.sideways + b.sideways, a.turn + b.turn};
  }
};

/// How wheels move the body over a row: (f, s, a) = forward, to the left [m], turn [rad] of the
/// body's reference point, from the wheels' travels w [m] and the steering angle b [rad, left
/// positive, mean over the row].
///
///   differential   w = left, right             f = (w1 + w2)/2, a = (w2 - w1)/wheelbase
///   unicycle       w = travel [m], turn [rad]  f = w1, a = w2; or of travel alone, where a is what
///                                              the gyro says. Noise, and what wears, are those of
///                                              two wheels that are `wheelbase` apart
///   skid_steer     w = left ones, right ones   the same of their means; `wheelbase` is the
///                                              effective one
///   tricycle       w = of the steered wheel    f = w (cos b + sin b z/length),
///                                              a = w sin b/length
///   ackermann      w = of a rear wheel         f = w/(1 - y k), a = f k,
///                                              k = tan b/(length + z tan b), with the wheel y to
///                                              the left of the rear axle's centre; both: with the
///                                              wheel whose angle is read z to the left of the
///                                              middle
///   omni3          w = front right, front      f = (w2 - w1)/sqrt 3, s = (2 w3 - w1 - w2)/3,
///                  left, rear                  a = -(w1 + w2 + w3)/(3 length); 120 degrees apart,
///                                              w positive where it turns the robot clockwise
///   mecanum        w = front left, front       f = (w1 + w2 + w3 + w4)/4,
///                  right, rear left, rear      s = (-w1 + w2 + w3 - w4)/4,
///                  right                       a = (-w1 + w2 - w3 + w4)/(2 (wheelbase + length))
///   wheels         w = any columns             (f, s, a) = matrix w
enum class DriveKind {
  differential,
  unicycle,
  skid_steer,
  tricycle,
  ackermann,
  omni3,
  mecanum,
  wheels
};

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

/// Where something sits on the robot, from its body's reference point, the axle's centre.
struct Mounting {
  double x = 0.0;    ///< m ahead
  double y = 0.0;    ///< m to the left
  double yaw = 0.0;  ///< rad by which it looks further left than the robot

  friend bool operator==(const Mounting& a, const Mounting& b) = default;
};

/// Where the sensors are believed to sit, one for each kind of measurement: effects (lever,
/// antenna, scanner, ...) add to it. Where nothing is stated: at the reference point, looking
/// ahead.
struct Mountings {
  std::optional<Mounting> sensor = {};   ///< what sightings are seen by, or stands on landmarks
  std::optional<Mounting> antenna = {};  ///< what fixes are of; it has no yaw
  std::optional<Mounting> tracked = {};  ///< what the truth tracks
  std::optional<Mounting> scanner = {};  ///< the axes in which loops tell its motion

  friend bool operator==(const Mountings& a, const Mountings& b) = default;
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
  double steer_left = 0.0;              ///< m, tricycle and ackermann: the steered wheel's y
  std::vector<WheelPlace> places = {};  ///< of `wheels`; empty: the matrix is given
  Eigen::MatrixXd matrix = {};          ///< of `wheels`: 3 x columns
  Mountings mounted = {};               ///< its sensors
};

/// The matrix that wheels at these places have: of least squares where more than needed. Wheels
/// that show no way to the side leave s = 0. Throws std::invalid_argument where they do not show
/// forward and turn, or where they mix one of them with s.
[[nodiscard]] Eigen::MatrixXd wheel_matrix(const std::vector<WheelPlace>& places);

/// How the gyro's reading of a row was taken into its motion (odometry/wheels_and_gyro.hpp).
struct GyroShare {
  BodyMotion wheels;      ///< the wheels' own
  double excess = 0.0;    ///< rad by which the gyro's turn exceeds the wheels'; 0 without a reading
  double variance = 0.0;  ///< rad^2, of the gyro's turn; infinite without a reading
  double along = 0.0;     ///< m of travel that a radian of excess adds
  double turn = 0.0;      ///< share of the excess that is taken as turn, from 0 to 1
  double lateral = 0.0;   ///< m to the left that a radian of excess adds
};

/// A wheel, or the steering, of a drive that is not simply a left and a right wheel.
struct WheelColumn {
  std::string name;             ///< its column of drive.csv
  bool steers = false;          ///< an angle, not a travel
  std::vector<double> reading;  ///< m, signed travel; rad where it steers
  /// d(forward [m], sideways [m, to the left], turn [rad])/d(reading), per row.
  std::vector<std::array<double, 3>> by_reading;
  /// Of what steers, where effects have it turn further: rad per rad read, per row; by_reading is
  /// by what it turns.
  std::vector<double> gain = {};
};

/// Two wheels' travels, row by row.
struct WheelPair {
  std::vector<double> left;   ///< m, signed
  std::vector<double> right;  ///< m, signed

  [[nodiscard]] bool empty() const { return left.empty(); }
  [[nodiscard]] WheelTravel at(std::size_t row) const { return {left[row], right[row]}; }
};

/// Of two wheels: how they move the body by effects that have their factors far from the robot's.
struct WheelFactors {
  Eigen::Matrix2d by_travel;  ///< d(forward [m], turn [rad])/d(left, right) [m]
  Eigen::Matrix2d shown;      ///< d(forward, turn) as the wheels show it/d(as it is)
};

/// A drive as motion of its robot's body, row by row: by the wheels as with_wheels makes it; then
/// steering effects or far factors of wheels, and the gyro are taken in, once each.
struct MotionRows : DriveColumns {
  std::vector<double> forward;   ///< m
  std::vector<double> turn;      ///< rad to the left
  std::vector<double> sideways;  ///< m that the body moves to the left; empty = 0
  /// Of two wheels: their own travels, by the robot's wheelbase; empty of other drives.
  WheelPair pair;
  std::vector<WheelColumn> wheels;    ///< the robot's own; empty of two wheels, and of a unicycle
  std::vector<std::string> unicycle;  ///< the columns of a unicycle; of others empty
  std::vector<GyroShare> gyro;        ///< once it is taken in
  /// m ahead and rad that steering effects (effects/steering.hpp) have added; shapes see the drive
  /// without. Empty where none are taken in.
  std::vector<std::array<double, 2>> steered;
  /// Once far factors of wheels (effects/wheel_factors.hpp) are taken in; shapes and effects see
  /// the drive without.
  std::optional<WheelFactors> factors;

  /// Whether the robot has a left and a right wheel, of which each can be wrong by itself.
  [[nodiscard]] bool of_two_wheels() const { return wheels.empty() && unicycle.empty(); }
  /// By the wheels, or by wheels and gyro together.
  [[nodiscard]] BodyMotion motion(std::size_t row) const {
    return {forward[row], slip(row), turn[row]};
  }
  /// By the wheels alone.
  [[nodiscard]] BodyMotion wheel_motion(std::size_t row) const {
    return gyro.empty() ? motion(row) : gyro[row].wheels;
  }
  /// m to the left.
  [[nodiscard]] double slip(std::size_t row) const {
    return sideways.empty() ? 0.0 : sideways[row];
  }
  /// m, how far the body moves in the row, forwards, backwards or to the side.
  [[nodiscard]] double way(std::size_t row) const {
    return sideways.empty() ? std::abs(forward[row]) : std::hypot(forward[row], sideways[row]);
  }
  /// Whether no wheel moves in the row.
  [[nodiscard]] bool rests(std::size_t row) const {
    const BodyMotion own = wheel_motion(row);
    return own.forward == 0.0 && own.turn == 0.0 && own.sideways == 0.0;
  }
};

/// A recording of a robot: what everything takes that reckons with motion.
struct DrivenRecording : Observations {
  MotionRows drive;
};

/// The recording as motion of this robot, by the columns that the robot names (else left and
/// right): of two wheels with the robot's wheelbase in its turns, so that a robot with another one
/// takes it anew. Columns stay covariates. Throws InputError where a column is not there, a reading
/// is impossible, or where the drive has no wheels at all; std::invalid_argument where the robot
/// has no wheelbase above 0 m.
[[nodiscard]] DrivenRecording with_wheels(Recording recording, const Robot& robot);
[[nodiscard]] std::vector<DrivenRecording> with_wheels(std::vector<Recording> recordings,
                                                       const Robot& robot);

}  // namespace trussmap
