// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// What is believed of a robot: its geometry, its noise, and the physical effects in its odometry.
// model_file.hpp reads and writes it as a TOML file.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/robot.hpp"
#include "trussmap/shape.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

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
