// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Options of trussmap simulate.
#pragma once

#include "command_line.hpp"
#include "effect_options.hpp"
#include "trussmap/simulated_recording.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

struct SimulateOptions : SimulationSettings {
  bool seed_drawn = false;  // for --hide without --seed
  EffectOptions effects;
  std::vector<double> sensor = {};   // x, y, yaw
  std::vector<double> antenna = {};  // x, y
  std::vector<double> scanner = {};  // x, y, yaw
  std::string plan_file;
  std::string out;
  std::string json;
};

/// Throws UsageError where an option was given that the drive does not have.
void check_drive_options(const Command& command, const SimulateOptions& options);

/// Where the options have the sensors.
[[nodiscard]] Mountings mounted_by(const SimulateOptions& options);

void add_simulate_options(const Command& command, SimulateOptions& options);

}  // namespace trussmap::app
