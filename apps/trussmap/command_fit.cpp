// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fit: the coefficients of a model's effects.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "results/common.hpp"
#include "results/criticism.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>
#include <optional>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct FitCommand {
  ModelRecordingsOptions input;
  std::string out;
  bool noise = false;
  PageOptions page;
  std::string tolerance;
};

/// The model without effects and as fitted, side by side.
EffectGain fit_both(const ModelRecordings& input, const Model& model, const FitCommand& options,
                    Progress& progress) {
  FitOptions how = fit_options(options.input);
  Model without = model;
  without.effects.clear();
  progress.next();
  how.fit_effects = false;
  const ModelFit before = fit_model(input.recordings, without, how);
  how.fit_effects = true;
  progress.next();
  const ModelFit after = fit_model(input.recordings, model, how);
  progress.next();
  return gain_of_effects(input.recordings, before, after, options.input.legs);
}

void run_fit(const FitCommand& options) {
  std::vector<ProgressStep> steps{{"reading", 0.5},
                                  {"fitting without effects", 2.5},
                                  {"fitting the effects", 5},
                                  {"predicting held-out legs", 8}};
  if (options.noise) steps.insert(steps.begin() + 1, {"estimating the noise", 8});
  if (options.page.wanted()) steps.push_back({"comparing both", 50});
  Progress progress(steps);
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  if (input.model.effects.empty() && !options.noise) {
    throw UsageError(options.input.model +
                     " has no effect to fit, expected one or more (see trussmap add)");
  }
  Model model = input.model;
  std::optional<FittedNoise> noise;
  if (options.noise) {
    progress.next();
    noise = fit_model_and_noise(input.recordings, model, fit_options(options.input)).noise;
    model.noise = noise->noise;
  }
  const EffectGain result = fit_both(input, model, options, progress);
  const RobotConstants constants = with_velocity_variances(
      robot_constants(input.model, result.with), input.recordings, result.with.model);
  const std::optional<Tolerance> tolerance = judged(options.tolerance, result.held_out_with);
  Files files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(result.with.model));
  if (!options.input.json.empty()) {
    const results::FitReport report{&result, &noise, &input.notes, tolerance};
    files.emplace_back(options.input.json,
                       results::json_text(results::WithConstants{report, &constants}));
  }
  progress.next();
  if (options.page.wanted()) {
    FitEvidence evidence = evidence_of(input.recordings, result, compare_options(options.input));
    if (noise) evidence.noise = in_words(*noise);
    const std::string subject = subject_of(options.input.recordings, options.input.model);
    add_page(files,
             with_tolerance(with_drive(with_constants(fit_page(evidence, subject), constants),
                                       input.model.robot, input.recordings),
                            tolerance),
             options.page, input.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}{}", fit_text(result, noise, style_of(stdout)),
             constants_text(constants, style_of(stdout)), notes_text(input.notes));
  end_by(tolerance);
}

}  // namespace

void setup_fit(const Command& app) {
  auto options = std::make_shared<FitCommand>();
  const Command command =
      app.add_subcommand("fit", "Estimate the coefficients of a model's effects from recordings");
  add_model_recordings(command, options->input);
  command.add_option("--out", options->out, "Write the model with its coefficients (TOML)")
      .type_name("FILE");
  command.add_flag("--noise", options->noise,
                   "Estimate the noise, too: the size of every source, and which part of it lasts");
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Effects without coefficients start at 0. A coefficient that these recordings cannot show "
      "is\n"
      "left as it was, and named. The held-out figures are those of a fit without these legs.");
  command.callback([options] { run_fit(*options); });
}

}  // namespace trussmap::app
