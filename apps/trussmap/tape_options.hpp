// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the calibrations with a tape measure have in common: the model they start from, and the
// robot that rehearses them.
#pragma once

#include "command_line.hpp"
#include "page_runtime.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/wheel_noise.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::app {

/// How ends are measured in a corner, for the end of a command's help.
inline constexpr const char* kWallHelp =
    "\n\nWith --wall-sensors both ends of a run are measured in a corner, by distances to its two "
    "walls\n"
    "[m]; RUNS.csv then has start1,start2,start3,end1,end2,end3, before and after the run, and\n"
    "odometry_x,odometry_y,odometry_heading, where the odometry had the end, counted from the "
    "start.\n"
    "FILE has the columns faces,x,y[,sd], a row per sensor in that order: faces is ahead, left,\n"
    "behind or right, x ahead and y to the left of the axle's centre [m], sd of a distance [m]. "
    "Two\n"
    "sensors face one wall, the third a wall at right angles to it.";

struct TapeOptions {
  std::string model;
  std::optional<double> wheelbase;  // m
  std::string wall_sensors;
  std::string out;
  std::string json;
  PageOptions page;
  bool simulate = false;
  double true_e_d = 1.0;
  double true_e_b = 1.0;
  double true_k_left = 0.0;      // m^1/2
  double true_k_right = 0.0;     // m^1/2
  double scatter = 0.0;          // m
  double scatter_heading = 0.0;  // rad
  int runs = 5;
  std::uint64_t seed = 1;
  std::string write;
};

/// --wheelbase, --model, --out and --json.
void add_tape_model_options(const Command& command, TapeOptions& options);

/// --simulate, and what belongs to it.
void add_rehearsal_options(const Command& command, TapeOptions& options);

/// All of them, walls and pages too.
void add_tape_options(const Command& command, TapeOptions& options);

/// Refuses neither or both of runs and --simulate, and options that go with --simulate alone.
void check_source(const Command& command, const TapeOptions& options, bool has_files);

/// The model given, or one with the wheelbase alone. Throws UsageError without either, and on a
/// wheelbase that no robot has.
[[nodiscard]] Model starting_model(const TapeOptions& options);

/// Where the sensors are that measure the ends by distances to walls; none without --wall-sensors.
[[nodiscard]] std::optional<WallSensors> wall_sensors(const TapeOptions& options);

/// The robot to rehearse with.
[[nodiscard]] TapeRobot simulated_robot(const TapeOptions& options, double wheelbase);

}  // namespace trussmap::app
