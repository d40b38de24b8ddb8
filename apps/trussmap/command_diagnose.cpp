// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap diagnose: which physical effect is missing from a model.
#include "commands.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "noise_output.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct DiagnoseCommand {
  ModelRecordingsOptions input;
  std::size_t list = 8;
  PageOptions page;
  std::string tolerance;
};

ordered_json json_of(const Finding& finding) {
  const Effect& effect = finding.effect;
  ordered_json one = effect_json(effect);
  one["score"] = finding.score;
  one["dof"] = finding.dof;
  one["p_value"] = finding.p_value;
  one["p_adjusted"] = finding.p_adjusted;
  one["status"] = name_of(finding.status);
  one["coefficients"] = numbers_or_null(effect.coefficients);
  one["sd"] = numbers_or_null(finding.sd);
  one["smallest_detectable"] = numbers_or_null(finding.minimal_detectable);
  one["heldout"] = metrics_json(finding.held_out);
  one["log_evidence"] = finding.evidence;
  one["tried"] = finding.tried;
  one["implausible"] = finding.implausible;
  one["indistinguishable_from"] = look_alikes_json(finding.look_alikes);
  return one;
}

ordered_json json_of(const Unobservable& unseen) {
  const Advice advice = advice_on(unseen);
  ordered_json one = effect_json(unseen.effect);
  one["why"] = advice.why;
  one["remedy"] = advice.drive;
  return one;
}

ordered_json json_of(const NoiseTest& test) {
  return {{"law", test.law},           {"score", test.score},
          {"dof", test.dof},           {"p_adjusted", test.p_adjusted},
          {"size", test.size},         {"unit", test.unit},
          {"in_words", in_words(test)}};
}

ordered_json json_of(const EventTest& event) {
  return {{"kind", name_of(event.kind)},    {"name", event.name},
          {"score", event.score},           {"dof", event.dof},
          {"p_adjusted", event.p_adjusted}, {"in_words", in_words(event)}};
}

template <typename Item>
ordered_json list_json(const std::vector<Item>& items) {
  ordered_json list = ordered_json::array();
  for (const Item& one : items) list.push_back(json_of(one));
  return list;
}

ordered_json json_of(const Diagnosis& result) {
  return {
      {"verdict", verdict_of(result)},
      {"missing", result.missing},
      {"p_value", result.p_value},
      {"chi2", result.chi2},
      {"dof", result.dof},
      {"coefficients_estimated", result.coefficients},
      {"heldout", held_out_json(result.held_out)},
      {"tried", result.tried},
      {"candidates", list_json(result.findings)},
      {"noise", list_json(result.noise)},
      {"noise_estimated", result.under ? noise_json(result.under->noise) : ordered_json(nullptr)},
      {"outliers", list_json(result.events)},
      {"advice", in_words(result.lacks)},
      {"next_drive", in_words(result.next_drive)},
      {"unobservable", list_json(result.unobservable)},
      {"warnings", result.warnings}};
}

void run_diagnose(const DiagnoseCommand& options) {
  std::vector<ProgressStep> steps{
      {"reading", 0.5}, {"fitting the map", 2.5}, {"looking for what is missing", 50}};
  if (options.page.wanted()) steps.push_back({"comparing with what is missing", 50});
  Progress progress(steps);
  progress.next();
  ModelRecordings input = read_model_recordings(options.input);
  const DiagnoseOptions how = diagnose_options(options.input);
  progress.next();
  ModelFit fit = fit_model(input.recordings, input.model, how.fit);
  progress.next();
  const Diagnosis result = diagnose(input, fit, how);
  const std::vector<NoiseBudget> budget =
      noise_budget(input.recordings, result.under ? result.under->fit.model : fit.model);
  const RobotConstants constants =
      with_velocity_variances(robot_constants(result, fit.model), input.recordings, fit.model);
  const std::optional<Tolerance> tolerance = judged(options.tolerance, result.held_out);
  Files files;
  if (!options.input.json.empty()) {
    ordered_json report = json_of(result);
    add_constants(constants, report);
    report["noise_budget"] = budget_json(budget);
    report["sightings_used"] = sightings_json(result.sightings);
    report["notes"] = input.notes;
    add_tolerance(tolerance, report);
    files.emplace_back(options.input.json, report.dump(2) + "\n");
  }
  progress.next();
  if (options.page.wanted()) {
    const Page page = diagnosis_page(result, evidence_of(input.recordings, fit, result, how),
                                     subject_of(options.input.recordings, options.input.model));
    add_page(files,
             with_tolerance(
                 with_drive(with_constants(page, constants), input.model.robot, input.recordings),
                 tolerance),
             options.page, input.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}{}", diagnosis_text(result, budget, options.list, style_of(stdout)),
             constants_text(constants, style_of(stdout)), notes_text(input.notes));
  end_by(tolerance);
}

}  // namespace

void setup_diagnose(const Command& app) {
  auto options = std::make_shared<DiagnoseCommand>();
  const Command command =
      app.add_subcommand("diagnose", "Find out which physical effect a model is missing");
  add_model_recordings(command, options->input);
  add_stated_noise(command, options->input);
  command.add_option("--list", options->list, "Candidates to list").capture_default_str();
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Tries the whole catalogue, and every channel against every variable and covariate. "
      "Missing:\n"
      "named by these data. Absent: would have been seen at any size that matters. Cannot tell:\n"
      "these data could not show it, or another effect looks the same. The page (--html) has what\n"
      "is missing, its rivals, the next drive, and the best change to each part of the robot.");
  command.callback([options] { run_diagnose(*options); });
}

}  // namespace trussmap::app
