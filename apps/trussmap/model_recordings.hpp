// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What compare, fit and their like have in common: a model, recordings, and what of them to use.
#pragma once

#include "command_line.hpp"
#include "trussmap/session.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::app {

struct ModelRecordingsOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string json;
  std::vector<std::string> without;
  std::vector<std::string> exclude;  ///< stretches of time
  double gate = kModelGate;          // sd, 0: none
  std::optional<double> every;  // s between frames of sightings; 0: all; absent: as errors last
  double level = kSignificance;
  LegOptions legs;
  bool stated_noise = false;
};

/// RECORDING..., --model, --json, --without, --exclude, --min-drive, --leg, --holdout, --gate,
/// --every,
/// --level.
void add_model_recordings(const Command& command, ModelRecordingsOptions& options,
                          bool required = true);

/// The same without --json and --level. `required`: RECORDING and --model are.
void add_fitted_recordings(const Command& command, ModelRecordingsOptions& options,
                           bool required = true);

/// --stated-noise.
void add_stated_noise(const Command& command, ModelRecordingsOptions& options);

/// One recording per folder, in their order. Throws InputError.
[[nodiscard]] std::vector<Recording> read_recordings(const std::vector<std::string>& folders,
                                                     bool drive_alone = false);

/// Reads them, warns of mistakes, and prepares them as the options say (session.hpp). Throws
/// InputError, with the model file's line where an effect cannot be applied. `drive_alone`: of
/// recordings that may have a drive and nothing else.
[[nodiscard]] Session read_session(const ModelRecordingsOptions& options, bool drive_alone = false);

}  // namespace trussmap::app
