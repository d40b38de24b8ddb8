// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fit: the coefficients of a model's effects.
#include "commands.hpp"
#include "criticism/score_test.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "report/fit_page.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"
#include "validation/held_out.hpp"
#include "wording/effect_words.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct FitOptions {
  ModelRecordingsOptions input;
  std::string out;
  PageOptions page;
};

/// The model as given and as fitted, side by side.
struct FitResult {
  ModelFit before;
  ModelFit after;
  HeldOut held_out_before;
  HeldOut held_out_after;
  double predicted = 0.0;  ///< decrease of chi^2, by the score test
};

FitResult fit_both(const ModelRecordings& input, const FitOptions& options, Progress& progress) {
  ModelFitOptions how;
  how.problem = problem_options(options.input);
  how.gate = gate_of(options.input);
  FitResult result;
  Model without = input.model;
  without.effects.clear();
  how.fit_effects = false;
  progress.next();
  result.before = fit_model(input.recordings, without, how);
  how.fit_effects = true;
  progress.next();
  result.after = fit_model(input.recordings, input.model, how);
  progress.next();
  result.held_out_before =
      predict_held_out(input.recordings, result.before, how, options.input.legs);
  result.held_out_after = predict_held_out(input.recordings, result.after, how, options.input.legs);
  std::vector<Effect> effects;
  for (const EffectEstimate& one : result.after.effects) {
    if (!one.effect.per_session) effects.push_back(one.effect);
  }
  const ScoreTest tests(result.before);
  if (!effects.empty()) result.predicted = tests.joint_score(effects);
  return result;
}

ordered_json json(const FitResult& result) {
  ordered_json effects = ordered_json::array();
  for (const EffectEstimate& one : result.after.effects) {
    effects.push_back(estimate_json(one));
    effects.back()["not_fitted"] = one.not_fitted;
  }
  const RecordingAdjustment& after = result.after.adjustment;
  return {{"chi2", after.chi2},
          {"dof", after.dof},
          {"p_value", after.p_value},
          {"effects", effects},
          {"heldout", held_out_json(result.held_out_after)},
          {"without_effects",
           {{"chi2", result.before.adjustment.chi2},
            {"dof", result.before.adjustment.dof},
            {"heldout", held_out_json(result.held_out_before)}}},
          {"predicted_decrease", result.predicted},
          {"warnings", after.warnings}};
}

void print(const FitResult& result) {
  for (const EffectEstimate& one : result.after.effects) {
    const bool none = std::all_of(one.effect.coefficients.begin(), one.effect.coefficients.end(),
                                  [](double a) { return a == 0.0; });
    const bool unseen = none && !one.not_fitted.empty();
    fmt::print("{}\n",
               verdict_text(unseen ? Mood::doubt : Mood::good,
                            fmt::format("{}: {}", one.effect.name,
                                        unseen ? "not fitted" : in_words(one.effect, one.sd))));
    TextTable table{{Align::left, Align::right, Align::right}, {}, false, 4};
    for (std::size_t k = 0; k < one.effect.coefficients.size(); ++k) {
      const QuantityText text = quantity_text(one.effect.coefficients[k], one.sd[k]);
      const Shape& shape = one.effect.shape[k % one.effect.shape.size()];
      table.rows.push_back({fmt::format("{} x {}", name_of(one.effect.channel), shape.text()),
                            text.value, text.error.empty() ? "" : "+- " + text.error});
    }
    fmt::print("{}", table_text(table));
    for (const std::string& why : one.not_fitted) fmt::print("    {}\n", why);
  }
  const RecordingAdjustment& before = result.before.adjustment;
  const RecordingAdjustment& after = result.after.adjustment;
  TextTable table{
      {Align::left, Align::right, Align::right, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"", "chi2", "dof", "p", "held out [mm]"});
  const auto row = [&table](const char* name, const RecordingAdjustment& fit, const HeldOut& held) {
    table.rows.push_back({name, fmt::format("{:.1f}", fit.chi2), fmt::format("{}", fit.dof),
                          probability_text(fit.p_value),
                          held.legs.empty() ? "-" : fmt::format("{:.1f}", 1e3 * held.arrival_rms)});
  };
  row("without effects", before, result.held_out_before);
  row("with them", after, result.held_out_after);
  fmt::print("\n{}", table_text(table));
  fmt::print("  chi2 was predicted to fall by {:.1f}, and fell by {:.1f}\n", result.predicted,
             before.chi2 - after.chi2);
  fmt::print("  {}\n", held_out_line(result.held_out_after));
  for (const std::string& warning : after.warnings) fmt::print("{}", warning_text(warning));
}

Page page_of(const ModelRecordings& input, const FitResult& result, const FitOptions& options) {
  const ScoreTest before(result.before);
  const ScoreTest after(result.after);
  const ComparisonOptions compared = comparison_options(options.input);
  FittedModel without = fitted_model(input.recordings, result.before, before, compared);
  without.comparison.held_out = result.held_out_before;
  FittedModel with = fitted_model(input.recordings, result.after, after, compared);
  with.comparison.held_out = result.held_out_after;
  return fit_page(without, with, fitted_effects(result.before, result.after.effects),
                  subject_of(options.input.recordings, options.input.model));
}

void run_fit(const FitOptions& options) {
  std::vector<ProgressStep> steps{{"reading", 0.5},
                                  {"fitting without effects", 2.5},
                                  {"fitting the effects", 5},
                                  {"predicting held-out legs", 8}};
  if (options.page.wanted()) steps.push_back({"comparing both", 50});
  Progress progress(steps);
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  if (input.model.effects.empty()) {
    throw UsageError(options.input.model +
                     " has no effect to fit, expected one or more (see trussmap add)");
  }
  const FitResult result = fit_both(input, options, progress);
  Files files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(result.after.model));
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, json(result).dump(2) + "\n");
  }
  progress.next();
  if (options.page.wanted()) add_page(files, page_of(input, result, options), options.page);
  write_files(files);
  progress.end();
  print(result);
}

}  // namespace

void setup_fit(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command =
      app.add_subcommand("fit", "Estimate the coefficients of a model's effects from recordings");
  add_model_recordings(*command, options->input);
  command->add_option("--out", options->out, "Write the model with its coefficients (TOML)")
      ->type_name("FILE");
  add_html_option(*command, options->page);
  add_plots_option(*command, options->page);
  command->footer(
      "Effects without coefficients start at 0. A coefficient that these recordings cannot show "
      "is\n"
      "left as it was, and named. The held-out figures are those of a fit without these legs.");
  command->callback([options] { run_fit(*options); });
}

}  // namespace trussmap::app
