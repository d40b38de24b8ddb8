// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap simulate: a recording of a wheeled robot on a mesh, with its nominal model.
#include "call_again.hpp"
#include "commands.hpp"
#include "results/json.hpp"
#include "results/simulation.hpp"
#include "sealed_answer.hpp"
#include "simulate_options.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// What the library refuses is an option out of place.
SimulatedRecording simulated(const SimulateOptions& options) {
  const std::vector<Effect> effects = effects_of(options.effects);
  try {
    return simulate(options, effects);
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    for (const Effect& effect : effects) {
      if (effect.line > 0 && what.starts_with(fmt::format("effect \"{}\"", effect.name))) {
        throw InputError(options.effects.model, effect.line, what);
      }
    }
    throw UsageError(what);
  }
}

/// An answer of an earlier recording must not stay beside a new one.
FolderOfFiles folder_of(const SimulateOptions& options, const SimulatedRecording& simulated) {
  NamedTexts beside = {{"model.toml", format_model(simulated.model)}};
  if (options.hide) {
    beside.emplace_back(
        kSealedName, sealed(results::json_of(results::Revealed{options.seed, &simulated.effects})));
  }
  FolderOfFiles folder =
      recording_folder(options.out, simulated.drive.recording, "", std::move(beside));
  if (!options.hide) folder.gone.emplace_back(kSealedName);
  return folder;
}

void run_simulate(const SimulateOptions& options) {
  const SimulatedRecording made = simulated(options);
  NamedContents files;
  if (!options.json.empty()) {
    files.emplace_back(options.json,
                       results::json_text(results::SimulationReport{
                           &options, &made, options.out, rough_names(rough_of(options))}));
  }
  write_files(files, {folder_of(options, made)});
  fmt::print("{}", simulation_text(made, options, options.out, style_of(stdout)));
  if (options.seed_drawn) {
    fmt::print("  They were drawn with --seed {}, which simulates the same recording again.\n",
               options.seed);
  }
  if (options.hide && !options.out.empty()) {
    const std::uint64_t next = options.seed + 1;
    fmt::print("  Try another: {}\n",
               call_with({{"--seed", std::to_string(next)}, {"--out", next_name(options.out)}}));
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
    options->mounted = mounted_by(*options);
    if (!options->plan_file.empty()) {
      options->plan = read_plan(options->plan_file);
      options->places_of_plan = command.count("--mesh") == 0;
      if (options->places_of_plan && (options->hide || options->uneven)) {
        throw UsageError(
            "simulate: --plan with --hide or --uneven is a further drive in a world "
            "that is drawn, expected its --mesh, too");
      }
    }
    if (options->hide && command.count("--seed") == 0) {
      options->seed = std::random_device()();
      options->seed_drawn = true;
    }
    run_simulate(*options);
  });
}

}  // namespace trussmap::app
