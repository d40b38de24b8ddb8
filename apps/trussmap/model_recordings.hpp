// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What compare, fit and their like have in common: a model, recordings, and what of them to use.
#pragma once

#include "criticism/comparison.hpp"
#include "trussmap/gate.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace trussmap::app {

struct ModelRecordingsOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string json;
  std::vector<std::string> without;
  double gate = kModelGate;  // sd, 0: none
  LegOptions legs;
};

/// RECORDING..., --model, --json, --without, --min-drive, --leg, --holdout, --gate.
void add_model_recordings(CLI::App& command, ModelRecordingsOptions& options);

struct ModelRecordings {
  Model model;
  std::vector<Recording> recordings;
};

/// Reads them. Throws InputError, with the model file's line where an effect cannot be applied.
[[nodiscard]] ModelRecordings read_model_recordings(const ModelRecordingsOptions& options);

[[nodiscard]] ProblemOptions problem_options(const ModelRecordingsOptions& options);
/// The same for compare(), with legs and gate.
[[nodiscard]] ComparisonOptions comparison_options(const ModelRecordingsOptions& options);
/// --gate as squared standard deviations.
[[nodiscard]] std::optional<double> gate_of(const ModelRecordingsOptions& options);

/// The held-out figures as formats.md has them.
[[nodiscard]] nlohmann::ordered_json held_out_json(const HeldOut& held_out);
/// The same in a line: "held out  35 legs  arrival 16.0 mm  ...".
[[nodiscard]] std::string held_out_line(const HeldOut& held_out);

}  // namespace trussmap::app
