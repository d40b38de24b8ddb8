// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap add: an effect into a model.
#include "commands.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct AddOptions {
  std::string model;
  std::string effect;
  std::string channel;
  std::vector<std::string> shape;
  bool per_session = false;
  std::string out;
};

/// The catalogue's effect of this name, or the user's own.
Effect effect_of(const AddOptions& options) {
  Effect effect;
  effect.name = options.effect;
  effect.per_session = options.per_session;
  std::string of_effect;
  try {
    if (options.channel.empty()) {
      const Effect known = catalogue_effect(options.effect);
      effect.channel = known.channel;
      effect.shape = known.shape;
      return effect;
    }
    of_effect = "effect \"" + options.effect + "\": ";
    effect.channel = channel_named(options.channel);
    effect.shape.assign(options.shape.begin(), options.shape.end());
    return effect;
  } catch (const std::invalid_argument& error) {
    throw UsageError(of_effect + error.what());
  }
}

void run_add(const AddOptions& options) {
  Model model = read_model(options.model);
  const auto same = [&options](const Effect& one) { return one.name == options.effect; };
  if (std::any_of(model.effects.begin(), model.effects.end(), same)) {
    throw UsageError(fmt::format("{} has an effect \"{}\" already, expected another name",
                                 options.model, options.effect));
  }
  if (options.channel.empty() != options.shape.empty()) {
    throw UsageError("--channel and --shape go together, expected both or a catalogue name alone");
  }
  const Effect effect = effect_of(options);
  model.effects.push_back(effect);
  write_file(options.out, format_model(model));
  fmt::print("{}: {} x {}, not fitted yet; see trussmap fit\n", effect.name,
             name_of(effect.channel), fmt::join(texts_of(effect.shape), ", "));
}

}  // namespace

void setup_add(const Command& app) {
  auto options = std::make_shared<AddOptions>();
  const Command command = app.add_subcommand("add", "Add a physical effect to a model");
  command.add_option("MODEL", options->model, "Model of the robot (TOML)")
      .required()
      .type_name("FILE");
  command
      .add_option("EFFECT", options->effect,
                  "Name from the catalogue (trussmap effects lists it), or your own")
      .required()
      .type_name("NAME");
  command.add_option("--channel", options->channel, "Where an effect of your own acts")
      .type_name("CHANNEL");
  command
      .add_option("--shape", options->shape,
                  "Expressions over the row's variables, one per coefficient")
      .type_name("EXPR...");
  command.add_flag("--per-session", options->per_session, "Coefficients of its own per recording");
  command.add_option("--out", options->out, "Write the model (TOML)").required().type_name("FILE");
  command.footer(
      "  trussmap add robot.toml wheelbase --out robot2.toml\n"
      "  trussmap add robot.toml \"tyre drift (temperature_C)\" --out robot2.toml\n"
      "  trussmap add robot.toml \"magnet in the lights\" --channel compass --shape lights "
      "--out robot2.toml");
  command.callback([options] { run_add(*options); });
}

}  // namespace trussmap::app
