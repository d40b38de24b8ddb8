// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "model_recordings.hpp"

#include "option_checks.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::app {
void add_model_recordings(const Command& command, ModelRecordingsOptions& options) {
  command.add_option("RECORDING", options.recordings, "Folders of CSV files, one per session")
      .required()
      .type_name("DIR");
  command.add_option("--model", options.model, "Model of the robot (TOML)")
      .required()
      .type_name("FILE");
  command.add_option("--json", options.json, "Write every figure as JSON").type_name("FILE");
  command
      .add_option("--holdout", options.legs.share,
                  "Share of the legs that is held out to judge the model by")
      .check(between(0.0, 0.9))
      .capture_default_str();
  command
      .add_option("--min-drive", options.legs.min_drive,
                  "Shortest leg between two landmarks [m of driven path]")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--leg", options.legs.leg,
                  "Length of a leg where there is truth but no landmark [m of driven path]")
      .check(above_zero())
      .capture_default_str();
  command.add_option("--without", options.without, "Do not use the survey, or the truth")
      .delimiter(',')
      .check(one_of({"survey", "truth"}))
      .type_name("WHAT,...");
  command
      .add_option("--gate", options.gate,
                  "Leave sightings out that all others contradict by more standard deviations than "
                  "this (0: leave none out)")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--level", options.level,
                  "Level of significance: chance of an effect, or a misfit, where there is none")
      .check(between(1e-6, 0.5))
      .capture_default_str();
}

ModelRecordings read_model_recordings(const ModelRecordingsOptions& options) {
  ModelRecordings result;
  for (const std::string& folder : options.recordings) {
    result.recordings.push_back(read_recording(folder));
  }
  result.model = read_model(options.model, result.recordings);
  return result;
}

FitOptions fit_options(const ModelRecordingsOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  FitOptions result;
  result.use_survey = !left_out("survey");
  result.use_truth = !left_out("truth");
  if (options.gate > 0.0) result.gate = options.gate * options.gate;
  return result;
}

CompareOptions compare_options(const ModelRecordingsOptions& options) {
  return {fit_options(options), options.legs, options.level};
}

DiagnoseOptions diagnose_options(const ModelRecordingsOptions& options) {
  return {fit_options(options), options.legs, options.level};
}

}  // namespace trussmap::app
