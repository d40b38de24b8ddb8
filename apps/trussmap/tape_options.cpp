// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "tape_options.hpp"

#include "commands.hpp"
#include "option_checks.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <charconv>

#include <fmt/format.h>

namespace trussmap::app {

namespace {

/// Millimetres for metres: no robot is that wide.
void require_narrow(const std::string& what, double wheelbase) {
  constexpr double kWidest = 10.0;     // m
  constexpr double kHundreds = 100.0;  // up to this many centimetres are a wheelbase
  if (wheelbase <= kWidest) return;
  const bool hundreds = wheelbase <= kHundreds;
  throw UsageError(fmt::format(
      "{} is {:g} m, wider than any robot, expected metres ({:g} for {:g} "
      "{}?)",
      what, wheelbase, wheelbase / (hundreds ? 100.0 : 1000.0), wheelbase, hundreds ? "cm" : "mm"));
}

}  // namespace

void add_tape_model_options(const Command& command, TapeOptions& options) {
  command
      .add_option("--wheelbase", options.wheelbase,
                  "Distance of the wheels that the robot calculates with [m]; may be left out with "
                  "--model, which has it, and with --simulate (0.34 then)")
      .check(length_of_robot());
  command.add_option("--model", options.model, "Model to start from (TOML)").type_name("FILE");
  command.add_option("--out", options.out, "Write the model with what was found (TOML)")
      .type_name("FILE");
  command.add_option("--json", options.json, "Write every figure as JSON").type_name("FILE");
}

void add_rehearsal_options(const Command& command, TapeOptions& options) {
  const std::string group = "Rehearsal with a simulated robot";
  command.add_flag("--simulate", options.simulate, "Let a simulated robot make the runs")
      .group(group);
  const auto add = [&](const char* name, double& value, const Check& check, const char* help) {
    command.add_option(name, value, help).check(check).capture_default_str().group(group);
  };
  add("--true-E-d", options.true_e_d, above_zero(), "Its right wheel over its left");
  add("--true-E-b", options.true_e_b, above_zero(), "Its true wheelbase over the nominal one");
  add("--true-k-left", options.true_k_left, zero_or_more(), "Noise of its left wheel [m^1/2]");
  add("--true-k-right", options.true_k_right, zero_or_more(), "Noise of its right wheel [m^1/2]");
  add("--scatter", options.scatter, zero_or_more(),
      "Error of a measured end position [m, standard deviation per coordinate]");
  add("--scatter-heading", options.scatter_heading, zero_or_more(),
      "Error of a measured end heading [rad, standard deviation]");
  command
      .add_option("--runs", options.runs,
                  "Number of runs; of umbmark, in each direction, of tape, of each kind")
      .check(whole_number(2))
      .capture_default_str()
      .group(group);
  command.add_option("--seed", options.seed, "The same seed gives the same runs")
      .check(whole_number(0))
      .capture_default_str()
      .group(group);
  command.add_option("--write", options.write, "Write the runs as CSV")
      .type_name("FILE")
      .group(group);
}

void add_tape_options(const Command& command, TapeOptions& options) {
  add_tape_model_options(command, options);
  command
      .add_option("--wall-sensors", options.wall_sensors,
                  "RUNS are distances to two walls, by three sensors: where these are (CSV)")
      .type_name("FILE");
  add_html_option(command, options.page);
  add_plots_option(command, options.page);
  add_rehearsal_options(command, options);
}

void check_source(const Command& command, const TapeOptions& options, bool has_files) {
  const bool simulate = options.simulate;
  if (simulate && has_files) {
    throw UsageError("both RUNS.csv and --simulate are given, expected one of them");
  }
  if (!simulate && !has_files) throw UsageError("no runs, expected RUNS.csv or --simulate");
  if (simulate && !options.wall_sensors.empty()) {
    throw UsageError("--wall-sensors is given with --simulate, expected it with RUNS.csv");
  }
  if (simulate) return;
  const std::string given = command.given_of_group("Rehearsal");
  if (!given.empty()) {
    throw UsageError(given + " is given without --simulate, to which it belongs");
  }
}

Model starting_model(const TapeOptions& options) {
  Model model;
  if (!options.model.empty()) {
    model = read_model(options.model);
    if (options.wheelbase && *options.wheelbase != model.robot.wheelbase) {
      throw UsageError("--wheelbase is not the wheelbase of " + options.model +
                       ", expected one of them, or the same");
    }
    require_narrow(options.model + ": wheelbase", model.robot.wheelbase);
  } else if (options.wheelbase) {
    require_narrow("--wheelbase", *options.wheelbase);
    model.robot.wheelbase = *options.wheelbase;
  } else if (!options.simulate) {
    throw UsageError("the wheelbase is missing, expected --wheelbase METRES or --model FILE");
  }
  return model;
}

std::optional<WallSensors> wall_sensors(const TapeOptions& options) {
  if (options.wall_sensors.empty()) return std::nullopt;
  return read_wall_sensors(options.wall_sensors);
}

TapeRobot simulated_robot(const TapeOptions& options, double wheelbase) {
  TapeRobot robot = misbuilt_robot(wheelbase, options.true_e_d, options.true_e_b);
  robot.left_noise = options.true_k_left;
  robot.right_noise = options.true_k_right;
  robot.tape_sd = options.scatter;
  robot.tape_heading_sd = options.scatter_heading;
  return robot;
}

}  // namespace trussmap::app
