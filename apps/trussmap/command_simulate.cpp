// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap simulate: a recording of a wheeled robot on a mesh, with its nominal model.
#include "commands.hpp"
#include "effect_options.hpp"
#include "option_checks.hpp"
#include "sealed_answer.hpp"
#include "simulation/hidden_effects.hpp"
#include "simulation/tours.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/random_stream.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
  std::vector<double> speeds = {0.25, 0.9};     // m/s
  std::vector<double> turn_rates = {0.3, 1.1};  // rad/s
  double ramp = 0.0;                            // s
  double overrun = -1.0;                        // m; negative: 0, or what a delay needs
  std::vector<std::string> covariates;
  EffectOptions effects;
  bool true_rates = false;
  bool hide = false;
  std::string out;
  std::string json;
};

constexpr double kGapSpread = 0.4;     // uneven: gaps of 1 -+ this times the spacing,
constexpr double kJitterShare = 0.06;  // and landmarks moved by up to this times the spacing
constexpr double kRestShare = 0.1;
constexpr double kDelayOverrun = 0.4;  // m: a robot that stands shows no delay

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

DrivingStyle make_style(const SimulateOptions& options, const std::vector<Effect>& effects) {
  DrivingStyle style;
  style.slowest = options.speeds.at(0);
  style.fastest = options.speeds.at(1);
  style.slowest_turn = options.turn_rates.at(0);
  style.fastest_turn = options.turn_rates.at(1);
  style.ramp = options.ramp;
  style.covariates = options.covariates;
  const bool delayed = std::any_of(effects.begin(), effects.end(),
                                   [](const Effect& one) { return one.channel == Channel::delay; });
  style.overrun = options.overrun >= 0.0 ? options.overrun : delayed ? kDelayOverrun : 0.0;
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

/// A recording and what was simulated in it.
struct Simulated {
  Mesh mesh;
  SimulatedDrive drive;
  std::vector<Effect> effects;
};

/// The walk, driven. What the library refuses is an option out of place.
Simulated simulate(const SimulateOptions& options) {
  Simulated result;
  result.effects = effects_of(options.effects);
  try {
    result.mesh = make_mesh(options);
    std::mt19937_64 random = random_stream(options.seed, Stream::walk);
    const Tours tours =
        make_tours(result.mesh, parse_walk_kind(options.walk), options.tours, random);
    const WheeledRobot robot = make_robot(options);
    if (options.hide) {
      const TrueMotion motion =
          lay_path(result.mesh, tours.walk, make_style(options, {}), options.seed);
      result.effects =
          draw_hidden_effects(motion, result.mesh, robot, !options.no_survey, options.seed);
    }
    result.drive = simulate_drive(
        result.mesh, tours.walk, make_style(options, result.effects), robot, options.seed,
        {result.effects, options.true_rates ? Rates::true_motion : Rates::as_recorded});
    if (options.no_survey) result.drive.recording.survey.clear();
    return result;
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    for (const Effect& effect : result.effects) {
      if (effect.line > 0 && what.starts_with(fmt::format("effect \"{}\"", effect.name))) {
        throw InputError(options.effects.model, effect.line, what);
      }
    }
    throw UsageError(what);
  }
}

/// An answer of an earlier recording must not stay beside a new one.
void write_folder(const SimulateOptions& options, const Simulated& simulated) {
  std::vector<std::pair<std::string, std::string>> beside = {
      {"model.toml", format_model(nominal_model(options))}};
  if (options.hide) {
    beside.emplace_back(kSealedName, sealed({{"seed", options.seed},
                                             {"effects", effects_json(simulated.effects)}}));
  }
  write_recording(options.out, simulated.drive.recording, "", beside);
  if (!options.hide) fs::remove(fs::path(options.out) / kSealedName);
}

nlohmann::json summary(const SimulateOptions& options, const Simulated& simulated) {
  const Mesh& mesh = simulated.mesh;
  const SimulatedDrive& drive = simulated.drive;
  double length = 0.0;
  for (const TrueRow& row : drive.motion.rows) length += row.speed * row.duration;
  nlohmann::json results = {{"recording", options.out},
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
  if (!options.hide) results["effects"] = effects_json(simulated.effects);
  return results;
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
  const Simulated simulated = simulate(options);
  write_folder(options, simulated);
  const nlohmann::json results = summary(options, simulated);
  if (!options.json.empty()) write_file(options.json, results.dump(2) + "\n");
  print(results);
  if (options.hide) {
    fmt::print("\n  Effects are hidden in it; `trussmap reveal {}` names them.\n", options.out);
  } else if (!simulated.effects.empty()) {
    fmt::print("\n{}", effects_table(effects_json(simulated.effects)));
  }
}

void add_driving_options(CLI::App& command, SimulateOptions& options) {
  const auto add_pair = [&](const char* name, std::vector<double>& value, const char* help) {
    command.add_option(name, value, help)
        ->delimiter(',')
        ->expected(2)
        ->check(above_zero())
        ->capture_default_str();
  };
  add_pair("--speeds", options.speeds, "Slowest and fastest leg [m/s], like 0.25,0.9");
  add_pair("--turn-rates", options.turn_rates,
           "Slowest and fastest turn on the spot [rad/s], like 0.3,1.1");
  command
      .add_option("--ramp", options.ramp,
                  "Time in which a drive reaches its speed and leaves it [s]")
      ->check(zero_or_more())
      ->capture_default_str();
  command
      .add_option("--overrun", options.overrun,
                  "How far the robot drives on before it turns, so that it sees landmarks in "
                  "passing [m]; 0.4 with a delay of the sightings, else 0")
      ->check(zero_or_more());
  command
      .add_option("--covariate", options.covariates,
                  "A further column, between 0 and 1, anew at one stop in two; payload_kg, lights "
                  "and temperature_C are always there; again for more")
      ->allow_extra_args(false);
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
  add_driving_options(command, options);
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
  add_effect_options(command, options->effects);
  command.add_flag("--true-rates", options->true_rates,
                   "Let effects of speed and turn_rate follow the true rates; otherwise the "
                   "recorded ones, so that a fit finds their values exactly");
  command
      .add_flag("--hide", options->hide,
                "Draw one or two effects from the catalogue; truth.json seals which (see reveal)")
      ->excludes("--effect")
      ->excludes("--effects");
  command.footer(catalogue_text());
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
