// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap noise: how noisy each wheel is, from one path driven many times.
#include "commands.hpp"
#include "option_checks.hpp"
#include "results/experiments.hpp"
#include "results/json.hpp"
#include "tape_options.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct NoiseOptions {
  std::string file;
  std::string path = "10,-10";
  std::vector<double> sensor_sd;  // m, m, rad
  std::vector<double> k;          // m^1/2
  bool subtract_mean = false;
  TapeOptions tape;
};

/// The wheelbase is the corrected one: the model's errors of geometry are corrected for.
NoiseExperiment make_experiment(const NoiseOptions& options, const Model& model) {
  NoiseExperiment experiment;
  try {
    experiment.path = parse_path(options.path);
    experiment.wheelbase = model.robot.wheelbase * geometry_errors(model).wheelbase_ratio;
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  for (std::size_t k = 0; k < options.sensor_sd.size(); ++k) {
    experiment.sensor_sd[static_cast<Eigen::Index>(k)] = options.sensor_sd[k];
  }
  experiment.subtract_mean = options.subtract_mean;
  return experiment;
}

EndErrors simulated_errors(const NoiseOptions& options, const NoiseExperiment& experiment) {
  std::mt19937_64 random = random_stream(options.tape.seed, Stream::wheels);
  const TapeRobot robot = simulated_robot(options.tape, experiment.wheelbase);
  EndErrors errors;
  for (const Pose& end : drive_often(robot, experiment.path, options.tape.runs, random)) {
    errors.push_back({end.x, end.y, end.heading});
  }
  return errors;
}

/// The ends as measured; what the measurement's own noise is goes into the experiment.
EndErrors measured_errors(const NoiseOptions& options, NoiseExperiment& experiment) {
  const double longest = largest_end_error(experiment.path, experiment.wheelbase);
  const std::optional<WallSensors> walls = wall_sensors(options.tape);
  if (!walls) return read_end_errors(options.file, longest);
  const bool states_sd =
      std::any_of(walls->begin(), walls->end(), [](const WallSensor& one) { return one.sd > 0.0; });
  if (states_sd && !options.sensor_sd.empty()) {
    throw UsageError("--sensor-sd is given, and " + options.tape.wall_sensors +
                     " has the column sd, expected one of them");
  }
  MeasuredEnds ends = read_wall_end_errors(options.file, *walls, longest);
  experiment.sensor_covariance = ends.covariance;
  return std::move(ends.errors);
}

NoiseAnalysis analyse(const NoiseOptions& options, const Model& model) {
  NoiseExperiment experiment = make_experiment(options, model);
  EndErrors errors = options.tape.simulate ? simulated_errors(options, experiment)
                                           : measured_errors(options, experiment);
  std::optional<Vector2> stated;
  if (!options.k.empty()) stated = Vector2(options.k[0], options.k[1]);
  return analyse_wheel_noise(std::move(errors), experiment, stated);
}

void run_noise(const NoiseOptions& options) {
  Model model = starting_model(options.tape);
  const NoiseAnalysis result = analyse(options, model);
  Files files;
  if (!options.tape.out.empty()) {
    model.noise.left = result.estimate.left.k;
    model.noise.right = result.estimate.right.k;
    files.emplace_back(options.tape.out, format_model(model));
  }
  if (!options.tape.json.empty()) {
    files.emplace_back(options.tape.json,
                       results::json_text(results::NoiseReport{&result, options.path}));
  }
  if (!options.tape.page.plots.empty()) {
    files.add_plot(options.tape.page.plots, "noise.svg",
                   noise_picture(result.errors, result.estimate, result.stated));
  }
  if (!options.tape.page.html.empty()) {
    const NoiseCalibration shown{result.errors, result.estimate,
                                 result.fit,    path_length(result.experiment.path),
                                 result.doubts, result.stated};
    add_page(files,
             noise_page(shown, (options.tape.simulate ? "a simulated robot" : options.file) +
                                   ", path " + options.path),
             {options.tape.page.html, {}});
  }
  if (!options.tape.write.empty()) {
    files.emplace_back(options.tape.write, format_end_errors(result.errors));
  }
  files.write();
  fmt::print("{}", wheel_noise_text(result, style_of(stdout)));
}

constexpr const char* kFooter =
    "RUNS.csv has the columns x,y,heading and a row per run: where the robot was measured to "
    "stand\n"
    "after the path minus where its odometry had it; x [m] ahead at the start, y [m] to the left,\n"
    "heading [rad] counter-clockwise.\n\n"
    "PATH: segments in the order driven, separated by commas. 10 is a straight drive of 10 m, -10 "
    "one\n"
    "backwards, a90 a turn on the spot by 90 degrees counter-clockwise, 3@45 an arc of 3 m that\n"
    "turns by 45 degrees, eight@1 a figure-eight of two circles of 1 m radius. Quote it:\n"
    "--path \"10,-10\".\n\n"
    "The variance of a wheel's travel is k^2 times the travel. Correct systematic errors first\n"
    "(umbmark), or leave them out with --subtract-mean.";

}  // namespace

void setup_noise(const Command& app) {
  auto options = std::make_shared<NoiseOptions>();
  options->tape.runs = 60;
  const Command command = app.add_subcommand(
      "noise",
      "Measure how noisy each wheel is: one path driven many times, k of both wheels by maximum "
      "likelihood (Chong & Kleeman 1997).");
  command.add_option("RUNS", options->file, "End errors of the runs (CSV)").type_name("FILE");
  command.add_option("--path", options->path, "Path driven in every run")
      .type_name("PATH")
      .capture_default_str();
  command
      .add_option("--sensor-sd", options->sensor_sd,
                  "Noise of the measured ends, standard deviations x,y,heading [m, m, rad]; "
                  "0,0,0 if left out")
      .delimiter(',')
      .expected(3)
      .check(zero_or_more())
      .type_name("X,Y,HEADING");
  command
      .add_option("--k", options->k,
                  "Judge this k of the wheels [m^1/2] as well: how many runs end within 1, 2 and 3 "
                  "standard deviations of what it predicts, its ellipses in the charts")
      .delimiter(',')
      .expected(2)
      .check(above_zero())
      .type_name("LEFT,RIGHT");
  command.add_flag("--subtract-mean", options->subtract_mean,
                   "Take the mean of the runs as a systematic error, not as noise");
  add_tape_options(command, options->tape);
  command.footer(std::string(kFooter) + kWallHelp);
  command.callback([options, command] {
    check_source(command, options->tape, !options->file.empty());
    run_noise(*options);
  });
}

}  // namespace trussmap::app
