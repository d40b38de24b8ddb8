// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Options of trussmap simulate, and the world, robot and driving style that they describe.
#pragma once

#include "command_line.hpp"
#include "effect_options.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::app {

/// Lengths in m, angles in rad, times in s.
struct SimulateOptions {
  std::string mesh = "6x6";
  double spacing = 5.0;  // m
  bool uneven = false;
  std::string walk = "euler";
  int tours = 3;
  std::uint64_t seed = 1;
  bool seed_drawn = false;  // for --hide without --seed
  std::string drive = "differential";
  double wheelbase = 0.34;        // m
  double length = 0.0;            // m; 0: the drive's usual one
  double wheel_left = 0.0;        // m
  double steer_noise = 0.005;     // rad m^1/2
  double wheel_noise = 0.003;     // m^1/2
  double compass_noise = 0.02;    // rad
  double sighting_noise = 0.005;  // m
  double survey_noise = 0.001;    // m
  std::string rough;              // kinds of noise that the model does not state; "" = none
  bool noise_free = false;
  bool no_compass = false;
  bool gyro = false;
  bool no_survey = false;
  bool range_sensor = false;
  bool ranges_alone = false;
  bool bearings_alone = false;
  bool rests = false;
  double gyro_noise = 0.0005;        // rad/s^1/2
  double gyro_walk = 0.0;            // rad/s per s^1/2
  double reach = 8.0;                // m
  double fix_rate = 0.0;             // Hz
  double fix_noise = 0.05;           // m
  double loop_noise = 0.05;          // m
  double loop_heading_noise = 0.01;  // rad
  double yaw_noise = 0.02;           // rad
  int full_turns = 0;
  std::vector<double> speeds = {0.25, 0.9};     // m/s
  std::vector<double> turn_rates = {0.3, 1.1};  // rad/s
  double ramp = 0.0;                            // s
  double overrun = -1.0;                        // m; negative: 0, or what a delay needs
  std::vector<std::string> covariates;
  EffectOptions effects;
  bool true_rates = false;
  bool hide = false;
  bool loops = false;
  bool markers = false;
  std::string out;
  std::string json;
};

/// Throws std::invalid_argument on a mesh that is no mesh.
[[nodiscard]] Mesh make_mesh(const SimulateOptions& options);

/// Throws UsageError where an option was given that the drive does not have.
void check_drive_options(const Command& command, const SimulateOptions& options);

[[nodiscard]] WheeledRobot make_robot(const SimulateOptions& options);

/// `effects`: those that act; a delay needs a robot that sees landmarks in passing.
[[nodiscard]] DrivingStyle make_style(const SimulateOptions& options,
                                      const std::vector<Effect>& effects);

/// The model that comes with the recording: its noise as stated, and no effect. A noise-free
/// recording keeps the noise in its model, since measurements are weighted by it.
[[nodiscard]] Model nominal_model(const SimulateOptions& options);

void add_simulate_options(const Command& command, SimulateOptions& options);

}  // namespace trussmap::app
