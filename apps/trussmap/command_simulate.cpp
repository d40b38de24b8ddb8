// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap simulate: a recording of a wheeled robot on a mesh, with its nominal model.
#include "trussmap/effects/model.hpp"
#include "trussmap/io/atomic_file.hpp"
#include "trussmap/io/model_toml.hpp"
#include "trussmap/io/recording_csv.hpp"
#include "trussmap/simulation/random_stream.hpp"
#include "trussmap/simulation/tours.hpp"
#include "trussmap/simulation/wheeled_robot.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "option_checks.hpp"

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string mesh = "6x6";
  double spacing = 5.0;  // m
  bool uneven = false;
  std::string walk = "euler";
  int tours = 3;
  std::uint64_t seed = 1;
  double wheelbase = 0.34;        // m
  double wheel_noise = 0.003;     // m^1/2
  double compass_noise = 0.02;    // rad
  double sighting_noise = 0.005;  // m
  double survey_noise = 0.001;    // m
  bool noise_free = false;
  bool no_compass = false;
  bool no_survey = false;
  bool range_sensor = false;
  double reach = 8.0;  // m
  bool rests = false;
  int full_turns = 0;
  std::string out;
  std::string json;
};

constexpr double kGapSpread = 0.4;     // uneven: gaps of 1 -+ this times the spacing,
constexpr double kJitterShare = 0.06;  // and landmarks moved by up to this times the spacing
constexpr double kRestShare = 0.1;

Mesh make_mesh(const SimulateOptions& options) {
  const MeshSize size = parse_mesh_size(options.mesh);
  if (!options.uneven) return even_mesh(size, options.spacing);
  std::mt19937_64 random = random_stream(options.seed, Stream::mesh);
  const double shortest = (1.0 - kGapSpread) * options.spacing;
  const double longest = (1.0 + kGapSpread) * options.spacing;
  const std::vector<double> x = random_lines(size.columns, shortest, longest, random);
  const std::vector<double> y = random_lines(size.rows, shortest, longest, random);
  return jittered(mesh_of_lines(x, y), kJitterShare * options.spacing, random);
}

WheeledRobot make_robot(const SimulateOptions& options) {
  WheeledRobot robot;
  robot.wheelbase = options.wheelbase;
  robot.compass = !options.no_compass;
  robot.range_sensor = options.range_sensor;
  robot.reach = options.reach;
  robot.noise.left = options.wheel_noise;
  robot.noise.right = options.wheel_noise;
  robot.noise.compass = options.compass_noise;
  robot.noise.survey = options.survey_noise;
  if (options.noise_free) robot.noise = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  return robot;
}

DrivingStyle make_style(const SimulateOptions& options) {
  DrivingStyle style;
  style.standing = options.noise_free ? 0.0 : options.sighting_noise;
  style.rest_share = options.rests ? kRestShare : 0.0;
  style.full_spins = options.full_turns;
  return style;
}

/// What the robot's owner believes: its noise, and no effect. A noise-free recording keeps the
/// noise in its model, lest nothing could be weighed against anything.
Model nominal_model(const SimulateOptions& options) {
  Model model;
  const SensorNoise sensors;
  model.robot.wheelbase = options.wheelbase;
  model.noise.left = options.wheel_noise;
  model.noise.right = options.wheel_noise;
  model.noise.compass = options.compass_noise;
  model.noise.sighting = options.sighting_noise;
  model.noise.range = sensors.range;
  model.noise.bearing = sensors.bearing;
  model.noise.survey = options.survey_noise;
  return model;
}

/// The walk, driven. What the library refuses is an option out of place.
SimulatedDrive simulate(const SimulateOptions& options, Mesh& mesh) {
  try {
    mesh = make_mesh(options);
    std::mt19937_64 random = random_stream(options.seed, Stream::walk);
    const Tours tours = make_tours(mesh, parse_walk_kind(options.walk), options.tours, random);
    SimulatedDrive drive =
        simulate_drive(mesh, tours.walk, make_style(options), make_robot(options), options.seed);
    if (options.no_survey) drive.recording.survey.clear();
    return drive;
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

void write_folder(const fs::path& folder, const SimulatedDrive& drive, const Model& model) {
  write_recording(folder, drive.recording, "", {{"model.toml", format_model(model)}});
}

nlohmann::json summary(const SimulateOptions& options, const Mesh& mesh,
                       const SimulatedDrive& drive) {
  double length = 0.0;
  for (const TrueRow& row : drive.motion.rows) length += row.speed * row.duration;
  return {{"recording", options.out},
          {"mesh", options.mesh},
          {"walk", options.walk},
          {"tours", options.tours},
          {"seed", options.seed},
          {"landmarks", mesh.landmarks()},
          {"routes", mesh.routes.size()},
          {"legs", drive.motion.stops.size() - 1},
          {"rows", drive.motion.rows.size()},
          {"sightings", drive.recording.sightings.size()},
          {"length_m", length},
          {"duration_s", drive.motion.rows.back().t},
          {"compass", drive.recording.drive.has_compass()},
          {"surveyed", drive.recording.survey.size()}};
}

void print(const nlohmann::json& s) {
  const int tours = s["tours"].get<int>();
  fmt::print("simulated: {} {} of a {} mesh, in {}\n\n", tours, tours == 1 ? "tour" : "tours",
             s["mesh"].get<std::string>(), s["recording"].get<std::string>());
  const auto line = [](const char* name, const std::string& value, const char* unit) {
    fmt::print("  {:<10} {:>10}{}{}\n", name, value, *unit == '\0' ? "" : " ", unit);
  };
  for (const char* name : {"landmarks", "routes", "legs", "rows", "sightings"}) {
    line(name, std::to_string(s[name].get<std::size_t>()), "");
  }
  line("length", fmt::format("{:.1f}", s["length_m"].get<double>()), "m");
  line("duration", fmt::format("{:.1f}", s["duration_s"].get<double>()), "s");
  line("compass", s["compass"].get<bool>() ? "yes" : "no", "");
  line("surveyed", std::to_string(s["surveyed"].get<std::size_t>()), "");
}

void run_simulate(const SimulateOptions& options) {
  Mesh mesh;
  const SimulatedDrive drive = simulate(options, mesh);
  write_folder(options.out, drive, nominal_model(options));
  const nlohmann::json results = summary(options, mesh, drive);
  if (!options.json.empty()) write_file(options.json, results.dump(2) + "\n");
  print(results);
}

void add_world_options(CLI::App& command, SimulateOptions& options) {
  command.add_option("--mesh", options.mesh, "Landmarks along x and along y, like 6x6")
      ->capture_default_str();
  command.add_option("--spacing", options.spacing, "Distance between neighbours [m]")
      ->check(above_zero())
      ->capture_default_str();
  command.add_flag("--uneven", options.uneven,
                   "Random distances (0.6 to 1.4 of the spacing) and landmarks a little off the "
                   "lines");
  command
      .add_option("--walk", options.walk, "How a tour covers the routes; each tour is drawn anew")
      ->check(CLI::IsMember({"euler", "face", "depth-first", "random"}))
      ->capture_default_str();
  command.add_option("--tours", options.tours, "Number of tours")
      ->check(whole_number(1))
      ->capture_default_str();
  command.add_option("--seed", options.seed, "The same seed gives the same recording")
      ->check(whole_number(0))
      ->capture_default_str();
  command.add_flag("--rests", options.rests, "Rest for 2 to 20 s at one stop in ten");
  command
      .add_option("--full-turns", options.full_turns,
                  "Stops at which the robot turns round twice to the left and twice to the right")
      ->check(whole_number(0))
      ->capture_default_str();
}

void add_robot_options(CLI::App& command, SimulateOptions& options) {
  const auto add_positive = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(above_zero())->capture_default_str();
  };
  add_positive("--wheelbase", options.wheelbase, "Distance of the wheels [m]");
  add_positive("--wheel-noise", options.wheel_noise,
               "k of both wheels [m^1/2]: a travel d is recorded with variance k^2 |d|");
  add_positive("--compass-noise", options.compass_noise, "Standard deviation of a reading [rad]");
  add_positive("--sighting-noise", options.sighting_noise,
               "How far off a landmark the robot stops [m, standard deviation per coordinate]");
  add_positive("--survey-noise", options.survey_noise,
               "Standard deviation of the survey [m per coordinate]");
  command.add_flag("--noise-free", options.noise_free,
                   "Leave all noise out of the recording (model.toml still states it)");
  command.add_flag("--no-compass", options.no_compass, "The robot has no compass");
  command.add_flag(
      "--range-sensor", options.range_sensor,
      "From each stop the robot also sees landmarks in reach (half of them, at random) "
      "by range (within 0.05 m) and bearing (within 0.02 rad)");
  add_positive("--reach", options.reach, "Reach of the range sensor [m]");
}

}  // namespace

void setup_simulate(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App& command = *app.add_subcommand(
      "simulate",
      "Write the recording of a simulated robot with two wheels, a compass and an eye for "
      "landmarks "
      "that tours a square mesh of landmarks, with a survey and the robot's model.");
  add_world_options(command, *options);
  add_robot_options(command, *options);
  command.add_flag("--no-survey", options->no_survey, "Write no survey.csv");
  command
      .add_option("--out", options->out,
                  "Folder to write drive.csv, sightings.csv, survey.csv and model.toml to; a "
                  "recording that is there already is replaced")
      ->required();
  command.add_option("--json", options->json, "Write the results to this file as JSON");
  command.callback([options] { run_simulate(*options); });
}

}  // namespace trussmap::app
