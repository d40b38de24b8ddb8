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

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::app {

struct TapeOptions {
  std::string model;
  std::optional<double> wheelbase;  // m
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

void add_tape_options(const Command& command, TapeOptions& options);

/// Refuses neither or both of runs and --simulate, and options that go with --simulate alone.
void check_source(const Command& command, bool has_files);

/// The model given, or one with the wheelbase alone. Throws UsageError without either.
[[nodiscard]] Model starting_model(const TapeOptions& options);

/// The robot to rehearse with.
[[nodiscard]] TapeRobot simulated_robot(const TapeOptions& options, double wheelbase);

}  // namespace trussmap::app
