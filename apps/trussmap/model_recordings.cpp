// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "model_recordings.hpp"

#include "option_checks.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::app {
void add_model_recordings(CLI::App& command, ModelRecordingsOptions& options) {
  command.add_option("RECORDING", options.recordings, "Folders of CSV files, one per session")
      ->required()
      ->type_name("DIR");
  command.add_option("--model", options.model, "Model of the robot (TOML)")
      ->required()
      ->type_name("FILE");
  command.add_option("--json", options.json, "Write every figure as JSON")->type_name("FILE");
  command
      .add_option("--holdout", options.legs.share,
                  "Share of the legs that is kept aside to judge the model by")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command
      .add_option("--min-drive", options.legs.min_drive,
                  "Shortest leg between two landmarks [m of driven path]")
      ->check(zero_or_more())
      ->capture_default_str();
  command
      .add_option("--leg", options.legs.leg,
                  "Length of a leg where there is truth but no landmark [m of driven path]")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option("--without", options.without, "Do not use the survey, or the truth")
      ->delimiter(',')
      ->check(CLI::IsMember({"survey", "truth"}))
      ->type_name("WHAT,...");
  command
      .add_option("--gate", options.gate,
                  "Leave sightings out that all others contradict by more standard deviations than "
                  "this (0: leave none out)")
      ->check(zero_or_more())
      ->capture_default_str();
}

ModelRecordings read_model_recordings(const ModelRecordingsOptions& options) {
  ModelRecordings result;
  for (const std::string& folder : options.recordings) {
    result.recordings.push_back(read_recording(folder));
  }
  result.model = read_model(options.model, result.recordings);
  return result;
}

ProblemOptions problem_options(const ModelRecordingsOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  ProblemOptions result;
  result.survey = !left_out("survey");
  result.truth = !left_out("truth");
  return result;
}

ComparisonOptions comparison_options(const ModelRecordingsOptions& options) {
  ComparisonOptions how;
  how.problem = problem_options(options);
  how.legs = options.legs;
  how.gate = gate_of(options);
  return how;
}

std::optional<double> gate_of(const ModelRecordingsOptions& options) {
  if (!(options.gate > 0.0)) return std::nullopt;
  return options.gate * options.gate;
}

nlohmann::ordered_json held_out_json(const HeldOut& held_out) {
  return {{"legs", held_out.legs.size()},
          {"arrival_rms_m", held_out.arrival_rms},
          {"stretch_error", held_out.stretch_error},
          {"orientation_error_rad", held_out.orientation_error}};
}

std::string held_out_line(const HeldOut& held_out) {
  if (held_out.legs.empty()) return "no leg could be held out: too few, or --holdout 0";
  return fmt::format(
      "{} legs not used in the fit end {:.1f} mm off (rms), stretched by {:.2f} %, turned by "
      "{:.2f} "
      "mrad (means)",
      held_out.legs.size(), 1e3 * held_out.arrival_rms, 100.0 * held_out.stretch_error,
      1e3 * held_out.orientation_error);
}

}  // namespace trussmap::app
