// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap tape: wheels, wheelbase and gyro from straight runs, turns on the spot and rests.
#include "commands.hpp"
#include "option_checks.hpp"
#include "results/experiments.hpp"
#include "results/json.hpp"
#include "tape_options.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct TapeCommandOptions {
  std::string file;
  bool degrees = false;
  double true_e_s = 1.0;
  double true_gyro_scale = 0.0;
  double true_gyro_bias = 0.0;  // rad/s
  TapeOptions tape;
};

TapedRun rehearsed_straight(const TapeRobot& robot, std::mt19937_64& random) {
  constexpr double kLength = 10.0;  // m
  const Pose end = drive_once(robot, {{kLength, 0.0}}, random);
  TapedRun run;
  run.expected = std::hypot(kLength + end.x, end.y);
  run.odometry = kLength;
  run.heading = end.heading;
  return run;
}

/// Ten full turns, to the left or to the right, slowly or fast.
TapedRun rehearsed_turn(const TapeRobot& robot, const TapeCommandOptions& options, bool left,
                        bool fast, std::mt19937_64& random) {
  constexpr double kTurns = 20.0 * std::numbers::pi;
  constexpr double kSlow = 0.5;  // rad/s
  const double turn = left ? kTurns : -kTurns;
  const Pose end = drive_once(robot, {{0.0, turn}}, random);
  TapedRun run;
  run.kind = TapedKind::spin;
  run.expected = turn + end.heading;
  run.odometry = turn;
  run.seconds = kTurns / (fast ? 2.0 * kSlow : kSlow);
  run.gyro =
      (run.expected + options.true_gyro_bias * run.seconds) / (1.0 + options.true_gyro_scale);
  return run;
}

TapedRun rehearsed_rest(const TapeCommandOptions& options) {
  constexpr double kMinute = 60.0;  // s
  TapedRun run;
  run.kind = TapedKind::rest;
  run.seconds = kMinute;
  run.gyro = options.true_gyro_bias * kMinute / (1.0 + options.true_gyro_scale);
  return run;
}

/// What the gyro reads scatters by an angle random walk of a usual cheap one.
std::vector<TapedRun> rehearsed_runs(const TapeCommandOptions& options, double wheelbase) {
  constexpr double kGyroWalk = 2e-4;  // rad/sqrt(s)
  TapeRobot robot = simulated_robot(options.tape, wheelbase);
  robot.left_share *= options.true_e_s;
  robot.right_share *= options.true_e_s;
  std::mt19937_64 random = random_stream(options.tape.seed, Stream::wheels);
  std::mt19937_64 of_gyro = random_stream(options.tape.seed, Stream::gyro);
  std::normal_distribution<double> normal;
  std::vector<TapedRun> runs;
  runs.reserve(3 * static_cast<std::size_t>(options.tape.runs));
  for (int k = 0; k < options.tape.runs; ++k) runs.push_back(rehearsed_straight(robot, random));
  for (int k = 0; k < 2 * options.tape.runs; ++k) {
    runs.push_back(rehearsed_turn(robot, options, k % 2 == 0, k % 4 > 1, random));
  }
  for (int k = 0; k < options.tape.runs; ++k) runs.push_back(rehearsed_rest(options));
  for (TapedRun& run : runs) {
    if (run.kind != TapedKind::straight) {
      run.gyro += kGyroWalk * std::sqrt(run.seconds) * normal(of_gyro);
    }
  }
  return runs;
}

void run_tape(const TapeCommandOptions& options) {
  Model model = starting_model(options.tape);
  GeometryErrors in_force;
  std::vector<TapedConstant> constants;
  TapeCalibration found;
  std::vector<TapedRun> runs;
  try {
    in_force = geometry_errors(model);
    const double wheelbase = model.robot.wheelbase * in_force.wheelbase_ratio;
    runs = options.tape.simulate ? rehearsed_runs(options, wheelbase)
                                 : read_taped_runs(options.file, options.degrees);
    found = calibrate_by_tape(runs, wheelbase);
    constants = taped_constants(model, found);
    set_taped(model, found);
  } catch (const std::invalid_argument& error) {
    throw UsageError((options.tape.model.empty() ? "tape" : options.tape.model) + ": " +
                     error.what());
  }
  Files files;
  if (!options.tape.out.empty()) files.emplace_back(options.tape.out, format_model(model));
  if (!options.tape.json.empty()) {
    files.emplace_back(options.tape.json,
                       results::json_text(results::TapeReport{&found, &constants}));
  }
  if (!options.tape.write.empty()) {
    files.emplace_back(options.tape.write, format_taped_runs(runs));
  }
  files.write();
  fmt::print("{}", tape_text(found, constants, style_of(stdout)));
}

constexpr const char* kTapeFooter =
    "RUNS.csv has the columns kind,expected,odometry and a row per run, several of each kind:\n"
    "  straight  a run straight on: what the tape measured from start to stop and what the\n"
    "            odometry said [m]\n"
    "  spin      a turn on the spot, ten full turns each way for instance: what was turned by\n"
    "            protractor or by a mark on the floor, and by the odometry [rad; left: above 0]\n"
    "  rest      the robot stands: nothing, or 0, in both\n"
    "and, each of them optional (a field may be empty):\n"
    "  heading   by how much it turned on a straight run, less what the odometry says [rad]; with\n"
    "            it the runs tell E_d\n"
    "  aside     how far left of where it was aimed a straight run ended [m]; with sd_start, how\n"
    "            exactly it was aimed [rad], it tells E_d, too. Without, nothing does: a start a\n"
    "            little askew looks the same\n"
    "  gyro      what the gyro turned in a spin or a rest [rad], or yaw_rate, its mean [rad/s]\n"
    "  seconds   how long a spin or a rest took [s]\n"
    "  sd, sd_odometry, sd_heading, sd_gyro   standard deviations of these; without, the runs'\n"
    "            scatter gives the errors\n"
    "Semicolons or tabs may part the fields, numbers may have decimal commas.\n\n"
    "E_s, E_d and E_b become the model's effects wheel scale, wheel diameter ratio and wheelbase,\n"
    "what the gyro has its effects gyro scale and gyro bias; what was not determined stays as it\n"
    "was. --model gives corrections that were in force while driving.";

}  // namespace

void setup_tape(const Command& app) {
  auto options = std::make_shared<TapeCommandOptions>();
  const Command command =
      app.add_subcommand("tape",
                         "Calibrate wheels, wheelbase and gyro with a tape measure: straight runs, "
                         "turns on the spot, rests.");
  command.add_option("RUNS", options->file, "What was measured, a row per run (CSV)")
      .type_name("FILE");
  command.add_flag("--degrees", options->degrees, "Angles in RUNS are degrees, not radians");
  add_tape_model_options(command, options->tape);
  add_rehearsal_options(command, options->tape);
  const std::string group = "Rehearsal with a simulated robot";
  command.add_option("--true-E-s", options->true_e_s, "Its true mean wheel size over the believed")
      .check(above_zero())
      .capture_default_str()
      .group(group);
  command
      .add_option("--true-gyro-scale", options->true_gyro_scale,
                  "By what share it turns more than its gyro says")
      .check(between(-0.9, 9.0))
      .capture_default_str()
      .group(group);
  command
      .add_option("--true-gyro-bias", options->true_gyro_bias,
                  "What its gyro reads too much [rad/s]")
      .check(between(-10.0, 10.0))
      .capture_default_str()
      .group(group);
  command.footer(kTapeFooter);
  command.callback([options, command] {
    check_source(command, options->tape, !options->file.empty());
    run_tape(*options);
  });
}

}  // namespace trussmap::app
