// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effect_options.hpp"

#include "commands.hpp"
#include "option_checks.hpp"
#include "terminal.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/simulated_recording.hpp"

#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// "-0.02,0.1".
std::vector<double> numbers(const std::string& option, std::string_view text) {
  std::vector<double> values;
  while (true) {
    const std::string_view one = text.substr(0, text.find(','));
    const std::optional<double> value = finite_number(one);
    if (!value) {
      throw UsageError(
          fmt::format("--effect \"{}\": \"{}\" is no number, expected NAME=VALUE or "
                      "NAME=VALUE,VALUE",
                      option, one));
    }
    values.push_back(*value);
    if (one.size() == text.size()) return values;
    text.remove_prefix(one.size() + 1);
  }
}

/// A name may hold "=" in its brackets, so the last one counts.
Effect named_effect(const std::string& option) {
  const std::size_t equals = option.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(
        fmt::format("--effect \"{}\": expected NAME=VALUE or NAME=VALUE,VALUE", option));
  }
  const std::string name = option.substr(0, equals);
  std::vector<double> values = numbers(option, std::string_view(option).substr(equals + 1));
  if (find_entry(name) == nullptr) {
    throw UsageError(
        fmt::format("--effect \"{}\": \"{}\" is not in the catalogue, whose names "
                    "trussmap effects lists{}",
                    option, name, what_was_meant(name)));
  }
  try {
    return catalogue_effect(name, std::move(values));
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

void add_effect_options(const Command& command, EffectOptions& options) {
  command
      .add_option("--effect", options.named,
                  "A physical effect of the catalogue (its names: below), "
                  "with a coefficient per shape; again for more effects")
      .type_name("NAME=X[,X...]")
      .one_value_each();
  command
      .add_option(
          "--effects", options.model,
          "Model whose [[effect]]s, with their coefficients, act too: any channel and shape")
      .type_name("FILE");
}

std::vector<Effect> effects_of(const EffectOptions& options) {
  std::vector<Effect> effects;
  if (!options.model.empty()) effects = read_effects(options.model);
  for (const std::string& option : options.named) effects.push_back(named_effect(option));
  for (Effect& effect : effects) {
    try {
      effect = simulated_effect(effect);
    } catch (const std::invalid_argument& error) {
      if (effect.line > 0) throw InputError(options.model, effect.line, error.what());
      throw UsageError(error.what());
    }
  }
  return effects;
}

std::string name_with_brackets(const CatalogueEntry& entry) {
  if (entry.of_covariate()) return name_of(entry, "COLUMN");
  if (!entry.has_parameters()) return std::string(entry.name);
  std::string open;
  for (const OpenParameter& one : entry.parameters) {
    open += fmt::format("{}{}=..", open.empty() ? "" : ", ", one.name);
  }
  return name_of(entry, open);
}

std::string catalogue_text() {
  std::string text = "Effects, with the unit of their coefficients (channel x shape):\n";
  for (const CatalogueEntry& entry : catalogue()) {
    text += fmt::format("  {:<42} {:<10} {} x {}\n", name_with_brackets(entry),
                        entry.unit.empty() ? "-" : entry.unit, name_of(entry.channel),
                        fmt::join(entry.pattern, "; "));
  }
  return text;
}

std::vector<Effect> effects_from(const nlohmann::ordered_json& list) {
  std::vector<Effect> effects;
  for (const auto& one : list) {
    Effect effect;
    effect.name = one.at("name");
    effect.channel = channel_named(one.at("channel").get<std::string>());
    for (const std::string shape : one.at("shape")) effect.shape.emplace_back(shape);
    effect.coefficients = one.at("coefficients").get<std::vector<double>>();
    effects.push_back(std::move(effect));
  }
  return effects;
}

}  // namespace trussmap::app
