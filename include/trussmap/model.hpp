// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is believed of a robot: its geometry, its noise, and the physical effects in its odometry.
// model_file.hpp reads and writes it as a TOML file.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/shape.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

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

/// How an error of a channel's g lasts.
enum class ProcessKind {
  white,                   ///< anew in every row or reading
  per_leg,                 ///< constant from one landmark that the robot stands on to the next, or
                           ///< from rest to rest where it stands on none
  per_session,             ///< constant in a recording
  per_pass,                ///< constant as long as a landmark stays in view
  correlated_in_t,         ///< Ornstein-Uhlenbeck: correlation exp(-|lag|/length), length in s
  correlated_in_distance,  ///< the same, length in m driven
  walk_in_t,               ///< from 0 at a recording's start, variance sd^2 per s
  walk_in_distance         ///< the same, per m driven
};

/// A source of noise: channel x process. It adds to what the white ones below state.
struct NoiseProcess {
  Channel channel = Channel::travel;
  ProcessKind process = ProcessKind::white;
  double sd = 0.0;      ///< unit of the channel's g; of a walk: per root of s or m
  double length = 0.0;  ///< s or m, where correlated
  double tails = 0.0;   ///< degrees of freedom of Student's t; 0: normal
  int line = 0;         ///< of the model file that it came from, 0: of none

  friend bool operator==(const NoiseProcess& a, const NoiseProcess& b) = default;
};

/// "per leg", "correlated in t", ...: as model files and reports have it.
[[nodiscard]] std::string_view name_of(ProcessKind process);
[[nodiscard]] bool is_correlated(ProcessKind process);
/// Correlated, or a walk.
[[nodiscard]] bool is_chain(ProcessKind process);
/// Throws std::invalid_argument, listing all names, where there is none of this name.
[[nodiscard]] ProcessKind process_named(std::string_view name);

/// Standard deviations. Wheel noise as Chong & Kleeman (1997), eq. 4: the variance of a wheel's
/// travel is k^2 |travel|. Of drives with other wheels than two, each wheel's k^2 is the mean of
/// k_L^2 and k_R^2.
struct Noise {
  double left = 0.003;           ///< k_L, m^(1/2)
  double right = 0.003;          ///< k_R, m^(1/2)
  double compass = 0.02;         ///< rad per reading
  double sighting = 0.005;       ///< m per coordinate, standing on a landmark
  double range = 0.05;           ///< m per range reading
  double bearing = 0.02;         ///< rad per bearing reading
  double survey = 0.001;         ///< m per coordinate
  double truth = 0.002;          ///< m per coordinate of a truth row
  double truth_heading = 0.005;  ///< rad per truth row
  double range_relative = 0.0;   ///< fraction of the range, added to `range` in quadrature
  double heading_per_s = 0.0;    ///< rad/s^(1/2)
  double heading_per_rad = 0.0;  ///< rad/rad^(1/2) turned
  double travel_per_s = 0.0;     ///< m/s^(1/2)
  double gyro = 0.001;           ///< rad/s^(1/2), angle random walk of the gyro
  double fix = 0.05;             ///< m per coordinate of a fix
  double loop = 0.05;            ///< m per coordinate of a loop
  double loop_heading = 0.01;    ///< rad per loop
  double steer = 0.005;          ///< rad m^(1/2): of the mean steering angle over a metre
  double yaw = 0.02;             ///< rad per yaw of a landmark, and of a surveyed one
  std::vector<NoiseProcess> processes = {};  ///< besides

  friend bool operator==(const Noise& a, const Noise& b) = default;
};

/// Channel x shape: each coefficient scales one shape. One of the catalogue comes from
/// catalogue_effect (catalogue.hpp).
struct Effect {
  std::string name;
  Channel channel = Channel::travel;
  std::vector<Shape> shape;
  std::vector<double> coefficients;  ///< empty until fitted
  bool per_session = false;          ///< one set of coefficients per recording
  int line = 0;                      ///< of the model file that it came from, 0: of none

  /// Whether its one coefficient is g itself, everywhere: shape "1".
  [[nodiscard]] bool is_constant() const { return shape.size() == 1 && shape.front() == "1"; }
};

struct Model {
  Robot robot;
  Noise noise;
  std::vector<Effect> effects;  ///< in the order they were added
};

}  // namespace trussmap
