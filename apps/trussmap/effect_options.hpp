// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects as a user names them on the command line: --effect NAME=VALUE[,VALUE...], and the
// effects of a model file.
#pragma once

#include "command_line.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/model.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

struct EffectOptions {
  std::vector<std::string> named;  ///< NAME=VALUE[,VALUE...]
  std::string model;               ///< file; "" = none
};

void add_effect_options(const Command& command, EffectOptions& options);

/// The model's effects, then the named ones: each with channel, shape and coefficients. Throws
/// UsageError, in one line.
[[nodiscard]] std::vector<Effect> effects_of(const EffectOptions& options);

/// "tyre drift (COLUMN)", "missed ticks (v0=..)": with what is open in brackets.
[[nodiscard]] std::string name_with_brackets(const CatalogueEntry& entry);

/// The catalogue's names with the unit of their coefficients, for --help.
[[nodiscard]] std::string catalogue_text();

/// [{"name", "channel", "shape", "coefficients"}].

/// The same read back.
[[nodiscard]] std::vector<Effect> effects_from(const nlohmann::ordered_json& list);

}  // namespace trussmap::app
