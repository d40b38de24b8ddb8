// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "model_recordings.hpp"

#include "option_checks.hpp"
#include "recording_warnings.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
void add_model_recordings(const Command& command, ModelRecordingsOptions& options, bool required) {
  command.add_option("--json", options.json, "Write every figure as JSON").type_name("FILE");
  add_fitted_recordings(command, options, required);
  command
      .add_option("--level", options.level,
                  "Level of significance: chance of an effect, or a misfit, where there is none")
      .check(between(1e-6, 0.5))
      .capture_default_str();
}

void add_fitted_recordings(const Command& command, ModelRecordingsOptions& options, bool required) {
  const Option recordings =
      command.add_option("RECORDING", options.recordings, "Folders of CSV files, one per session")
          .type_name("DIR");
  const Option model =
      command.add_option("--model", options.model, "Model of the robot (TOML)").type_name("FILE");
  if (required) {
    recordings.required();
    model.required();
  }
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
      .add_option(
          "--leg", options.legs.leg,
          "Length of a leg where there is truth, or fixes, but no landmark [m of driven path]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--without", options.without, "Do not use the survey, the truth, fixes, or loops")
      .delimiter(',')
      .check(one_of({"survey", "truth", "fixes", "loops"}))
      .type_name("WHAT,...");
  command
      .add_option(
          "--exclude", options.exclude,
          "Do not use what was measured and driven in these times: FROM:TO [s], or N:FROM:TO of "
          "the Nth recording")
      .delimiter(',')
      .check(stretch_of_time())
      .type_name("TIME,...");
  command
      .add_option(
          "--gate", options.gate,
          "Leave sightings, fixes and loops out that all others contradict by more standard "
          "deviations than this (0: leave none out)")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--every", options.every,
                  "Use one frame of sightings in so many seconds (0: all; else as long as their "
                  "errors are found to last and, of more than 30000 sightings, up to 1)")
      .check(zero_or_more());
}

namespace {

/// Stretches of time are of recordings that are there.
void check_stretches(const std::vector<Recording>& recordings,
                     const std::vector<std::string>& stretches) {
  for (const std::string& text : stretches) {
    const StretchOfTime one = parse_stretch(text);
    const std::size_t count = recordings.size();
    if (!one.recording && count > 1) {
      throw InputError(
          "--exclude " + text, 0,
          fmt::format("does not say of which of {} recordings, expected N:FROM:TO", count));
    }
    const std::size_t place = one.recording.value_or(0);
    if (place >= count) {
      throw InputError("--exclude " + text, 0,
                       fmt::format("there is no recording {}, expected 1 to {}", place + 1, count));
    }
    const Drive& drive = recordings[place].drive;
    if (drive.rows() == 0 || (one.time.from < drive.t.back() && one.time.to > drive.start())) {
      continue;
    }
    throw InputError("--exclude " + text, 0,
                     fmt::format("{} lasts from {:g} s to {:g} s, expected a part of that",
                                 recordings[place].name, drive.start(), drive.t.back()));
  }
}

/// --without, --exclude, --gate and what else says how the recordings are used.
SessionOptions session_options(const ModelRecordingsOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  SessionOptions result;
  result.fit = gated_fit(options.gate);
  result.fit.use_survey = !left_out("survey");
  result.fit.use_truth = !left_out("truth");
  result.fit.use_fixes = !left_out("fixes");
  result.fit.use_loops = !left_out("loops");
  for (const std::string& text : options.exclude) {
    const StretchOfTime one = parse_stretch(text);
    const std::size_t place = one.recording.value_or(0);
    if (result.fit.excluded.size() <= place) result.fit.excluded.resize(place + 1);
    result.fit.excluded[place].push_back(one.time);
  }
  result.legs = options.legs;
  result.every = options.every;
  result.level = options.level;
  result.estimate_noise = !options.stated_noise;
  return result;
}

}  // namespace

std::vector<Recording> read_recordings(const std::vector<std::string>& folders, bool drive_alone) {
  std::vector<Recording> result;
  result.reserve(folders.size());
  for (const std::string& folder : folders) result.push_back(read_recording(folder, drive_alone));
  return result;
}

void add_stated_noise(const Command& command, ModelRecordingsOptions& options) {
  command.add_flag("--stated-noise", options.stated_noise,
                   "Judge by the noise that the model states, instead of estimating it");
}

Session read_session(const ModelRecordingsOptions& options, bool drive_alone) {
  const std::vector<Recording> read = read_recordings(options.recordings, drive_alone);
  Model model = read_model(options.model, read);
  std::vector<DrivenRecording> recordings = with_wheels(read, model.robot);
  check_stretches(read, options.exclude);
  warn_of_mistakes(read, model, options.model, !drive_alone);
  return open_session(std::move(recordings), std::move(model), session_options(options));
}

}  // namespace trussmap::app
