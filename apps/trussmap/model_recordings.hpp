// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What compare, fit and their like have in common: a model, recordings, and what of them to use.
#pragma once

#include "command_line.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/gate.hpp"

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
void add_model_recordings(const Command& command, ModelRecordingsOptions& options);

/// The same without --json and --level.
void add_fitted_recordings(const Command& command, ModelRecordingsOptions& options);

/// --stated-noise.
void add_stated_noise(const Command& command, ModelRecordingsOptions& options);

/// Recordings as the model given has them.
struct ModelRecordings : PreparedRecordings {
  Model model;
};

/// One recording per folder, in their order. Throws InputError.
[[nodiscard]] std::vector<Recording> read_recordings(const std::vector<std::string>& folders,
                                                     bool drive_alone = false);

/// Reads them, and thins out frames whose errors last from one to the next (fit_model.hpp).
/// Throws InputError, with the model file's line where an effect cannot be applied.
/// `drive_alone`: of recordings that may have a drive and nothing else.
[[nodiscard]] ModelRecordings read_model_recordings(const ModelRecordingsOptions& options,
                                                    bool drive_alone = false);

/// --without, --exclude and --gate; the effects are fitted.
[[nodiscard]] FitOptions fit_options(const ModelRecordingsOptions& options);
[[nodiscard]] CompareOptions compare_options(const ModelRecordingsOptions& options);
[[nodiscard]] DiagnoseOptions diagnose_options(const ModelRecordingsOptions& options);

}  // namespace trussmap::app
