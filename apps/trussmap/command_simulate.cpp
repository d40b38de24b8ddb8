// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap simulate: a recording of a wheeled robot on a mesh, with its nominal model.
#include "commands.hpp"
#include "sealed_answer.hpp"
#include "simulate_options.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

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
  for (const Effect& effect : result.effects) {
    if (effect.channel != Channel::sighting_yaw || options.markers) continue;
    throw UsageError(
        fmt::format("effect \"{}\" acts on yaws of landmarks, expected --markers", effect.name));
  }
  try {
    result.mesh = make_mesh(options);
    std::mt19937_64 random = random_stream(options.seed, Stream::walk);
    const Tours tours =
        make_tours(result.mesh, parse_walk_kind(options.walk), options.tours, random);
    const WheeledRobot robot = make_robot(options);
    if (options.hide) {
      result.effects = draw_hidden_effects(result.mesh, tours.walk, make_style(options, {}), robot,
                                           !options.no_survey, options.seed);
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
FolderOfFiles folder_of(const SimulateOptions& options, const Simulated& simulated) {
  NamedTexts beside = {{"model.toml", format_model(nominal_model(options))}};
  if (options.hide) {
    beside.emplace_back(kSealedName, sealed({{"seed", options.seed},
                                             {"effects", effects_json(simulated.effects)}}));
  }
  FolderOfFiles folder =
      recording_folder(options.out, simulated.drive.recording, "", std::move(beside));
  if (!options.hide) folder.gone.emplace_back(kSealedName);
  return folder;
}

nlohmann::json summary(const SimulateOptions& options, const Simulated& simulated) {
  const Mesh& mesh = simulated.mesh;
  const SimulatedDrive& drive = simulated.drive;
  double length = 0.0;
  for (const TrueRow& row : drive.motion.rows) {
    length += std::hypot(row.speed, row.sideways) * row.duration;
  }
  nlohmann::json results = {{"recording", options.out},
                            {"mesh", options.mesh},
                            {"drive", options.drive},
                            {"walk", options.walk},
                            {"tours", options.tours},
                            {"seed", options.seed},
                            {"landmarks", mesh.landmarks()},
                            {"routes", mesh.routes.size()},
                            {"legs", drive.motion.stops.size() - 1},
                            {"rows", drive.motion.rows.size()},
                            {"sightings", drive.recording.sightings.size()},
                            {"fixes", drive.recording.fixes.size()},
                            {"loops", drive.recording.loops.size()},
                            {"length_m", length},
                            {"duration_s", drive.motion.rows.back().t},
                            {"compass", drive.recording.drive.has_compass()},
                            {"gyro", drive.recording.drive.has_gyro()},
                            {"surveyed", drive.recording.survey.size()},
                            {"rough", rough_names(make_robot(options).rough)}};
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
  for (const char* name : {"landmarks", "routes", "legs", "rows", "sightings", "fixes", "loops"}) {
    const bool extra = std::string_view(name) == "fixes" || std::string_view(name) == "loops";
    if (extra && s[name] == 0) continue;
    line(name, std::to_string(s[name].get<std::size_t>()), "");
  }
  line("length", fmt::format("{:.1f}", s["length_m"].get<double>()), "m");
  line("duration", fmt::format("{:.1f}", s["duration_s"].get<double>()), "s");
  line("compass", s["compass"].get<bool>() ? "yes" : "no", "");
  if (s["gyro"].get<bool>()) line("gyro", "yes", "");
  line("surveyed", std::to_string(s["surveyed"].get<std::size_t>()), "");
  const auto rough = s["rough"].get<std::vector<std::string>>();
  if (!rough.empty()) {
    fmt::print("\n  Its noise is not what model.toml states: {}.\n", fmt::join(rough, ", "));
  }
}

void run_simulate(const SimulateOptions& options) {
  const Simulated simulated = simulate(options);
  const nlohmann::json results = summary(options, simulated);
  NamedContents files;
  if (!options.json.empty()) files.emplace_back(options.json, results.dump(2) + "\n");
  write_files(files, {folder_of(options, simulated)});
  print(results);
  if (options.hide) {
    fmt::print("\n  Effects are hidden in it; `trussmap reveal {}` names them.\n", options.out);
    if (options.seed_drawn) {
      fmt::print("  They were drawn with --seed {}, which simulates the same recording again.\n",
                 options.seed);
    }
  } else if (!simulated.effects.empty()) {
    fmt::print("\n{}", effects_table(effects_json(simulated.effects)));
  }
}

}  // namespace

void setup_simulate(const Command& app) {
  auto options = std::make_shared<SimulateOptions>();
  const Command command = app.add_subcommand(
      "simulate",
      "Write the recording of a simulated robot with wheels, a compass and an eye for landmarks "
      "that tours a square mesh of landmarks, with a survey and the robot's model.");
  add_simulate_options(command, *options);
  command.callback([options, command] {
    check_drive_options(command, *options);
    if (options->hide && command.count("--seed") == 0) {
      options->seed = std::random_device()();
      options->seed_drawn = true;
    }
    run_simulate(*options);
  });
}

}  // namespace trussmap::app
