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
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct DiagnoseCommand {
  ModelRecordingsOptions input;
  std::size_t list = 8;
  PageOptions page;
};

ordered_json json(const Finding& finding) {
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

ordered_json json(const Unobservable& unseen) {
  const Advice advice = advice_on(unseen);
  ordered_json one = effect_json(unseen.effect);
  one["why"] = advice.why;
  one["remedy"] = advice.drive;
  return one;
}

ordered_json json(const NoiseTest& test) {
  return {{"law", test.law},           {"score", test.score},
          {"dof", test.dof},           {"p_adjusted", test.p_adjusted},
          {"size", test.size},         {"unit", test.unit},
          {"in_words", in_words(test)}};
}

ordered_json json(const EventTest& event) {
  return {{"kind", name_of(event.kind)},    {"name", event.name},
          {"score", event.score},           {"dof", event.dof},
          {"p_adjusted", event.p_adjusted}, {"in_words", in_words(event)}};
}

template <typename Item>
ordered_json list_json(const std::vector<Item>& items) {
  ordered_json list = ordered_json::array();
  for (const Item& one : items) list.push_back(json(one));
  return list;
}

ordered_json json(const Diagnosis& result) {
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

/// In the unit that suits the larger of it and what stands beside it.
std::string length(double metres, double beside) {
  return std::max(metres, beside) < 1.0 ? fmt::format("{:.1f} mm", 1e3 * metres)
                                        : fmt::format("{:.3f} m", metres);
}

void print_verdict(const Diagnosis& result) {
  if (result.verdict != Diagnosis::Verdict::missing) {
    const bool good = result.verdict == Diagnosis::Verdict::nothing_missing;
    fmt::print("{}\n", verdict_text(good ? Mood::good : Mood::bad, verdict_in_words(result)));
  }
  for (const Finding* found : found_by(result)) {
    const Finding& one = *found;
    const Mood mood = one.status == Status::missing ? Mood::bad : Mood::doubt;
    fmt::print("{}\n", verdict_text(mood, in_words(one)));
    for (const LookAlike& rival : one.look_alikes) {
      if (rival.told_apart()) {
        fmt::print(
            "  looks much like it: {} ({}), cosine {:.3f}; all measurements tell it apart (chi^2 "
            "{:.0f} behind)\n",
            rival.effect.name, formula_of(rival.effect), rival.cosine, rival.behind);
      } else {
        fmt::print("  looks the same here: {} ({}), cosine {:.3f}\n", rival.effect.name,
                   formula_of(rival.effect), rival.cosine);
      }
    }
  }
  if (!result.missing.empty() && !result.held_out.legs.empty()) {
    const bool several = result.findings.size() > 1 && !result.findings[1].joint.empty();
    const char* what = several ? "them" : "it";
    const double without = result.held_out.arrival_rms;
    const double with = result.with_missing.arrival_rms;
    fmt::print("  without {} legs end {} off, with {} {} (rms of {} held-out legs, predicted)\n",
               what, length(without, with), what, length(with, without),
               result.held_out.legs.size());
  }
  if (result.next_drive) fmt::print("  to tell them apart: {}\n", in_words(result.next_drive));
}

/// Noise laws and single events that are significant.
void print_others(const Diagnosis& result, std::size_t count) {
  std::size_t shown = 0;
  const bool estimated = result.under && result.under->noise.changed();  // shown by itself
  for (const NoiseTest& one : estimated ? std::vector<NoiseTest>() : result.noise) {
    if (one.p_adjusted >= kSignificance || shown >= 2) continue;
    if (shown++ == 0) fmt::print("\nMore noise than the model states\n");
    fmt::print("  {}: {} (score {:.1f}, p {})\n", one.law, in_words(one), one.score,
               probability_text(one.p_adjusted));
  }
  shown = 0;
  for (const EventTest& one : result.events) {
    if (one.p_adjusted >= kSignificance || shown >= count) continue;
    if (shown++ == 0) fmt::print("\nSingle events\n");
    fmt::print("  {} {}: {} (score {:.1f}, p {})\n", name_of(one.kind), one.name, in_words(one),
               one.score, probability_text(one.p_adjusted));
  }
}

/// What is significant by itself and yet absent is explained by what comes before it.
std::string status_text(const Finding& one) {
  if (one.implausible && one.status != Status::missing && one.p_adjusted < kSignificance)
    return "implausibly large";
  if (one.status == Status::absent && one.p_adjusted < kSignificance)
    return "explained by the above";
  return std::string(name_of(one.status));
}

void print_candidates(const Diagnosis& result, std::size_t count) {
  constexpr std::size_t kWidestCell = 36;  // characters; --json has all of it
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::right, Align::left},
                  {},
                  true,
                  2};
  table.rows.push_back({"best candidates", "channel x shape", "chi2 less (dof)", "p, adjusted",
                        "held out [mm]", "status"});
  for (std::size_t k = 0; k < std::min(count, result.findings.size()); ++k) {
    const Finding& one = result.findings[k];
    table.rows.push_back(
        {shortened(one.effect.name, kWidestCell), shortened(formula_of(one.effect), kWidestCell),
         fmt::format("{:.1f} ({})", one.score, one.dof), probability_text(one.p_adjusted),
         fmt::format("{:.1f}", 1e3 * one.held_out.arrival_rms), status_text(one)});
  }
  fmt::print("\n{}; {} tests\n{}", fit_in_words(result.chi2, result.dof, result.coefficients),
             result.tried, table_text(table));
}

void print(const Diagnosis& result, const DiagnoseCommand& options) {
  print_verdict(result);
  print_candidates(result, options.list);
  print_others(result, options.list);
  if (!result.unobservable.empty()) fmt::print("\nNot to be seen in these data\n");
  for (const Unobservable& one : result.unobservable) {
    const Advice advice = advice_on(one);
    fmt::print("  {}: {}; {}\n", one.effect.name, advice.why, advice.drive);
  }
  if (!result.lacks.empty()) fmt::print("\nWhat these data lack\n");
  for (const std::string& line : in_words(result.lacks)) fmt::print("  {}\n", line);
  for (const std::string& warning : result.warnings) fmt::print("{}", warning_text(warning));
}

void run_diagnose(const DiagnoseCommand& options) {
  std::vector<ProgressStep> steps{
      {"reading", 0.5}, {"fitting the map", 2.5}, {"looking for what is missing", 50}};
  if (options.page.wanted()) steps.push_back({"comparing with what is missing", 50});
  Progress progress(steps);
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  const DiagnoseOptions how = diagnose_options(options.input);
  progress.next();
  const ModelFit fit = fit_model(input.recordings, input.model, how.fit);
  progress.next();
  const Diagnosis result = diagnose(input.recordings, fit, how);
  const std::vector<NoiseBudget> budget =
      noise_budget(input.recordings, result.under ? result.under->fit.model : fit.model);
  Files files;
  if (!options.input.json.empty()) {
    ordered_json report = json(result);
    report["noise_budget"] = budget_json(budget);
    report["notes"] = input.notes;
    files.emplace_back(options.input.json, report.dump(2) + "\n");
  }
  progress.next();
  if (options.page.wanted()) {
    add_page(files,
             with_drive(diagnosis_page(result, evidence_of(input.recordings, fit, result, how),
                                       subject_of(options.input.recordings, options.input.model)),
                        input.model.robot, input.recordings),
             options.page);
  }
  files.write();
  progress.end();
  print(result, options);
  if (result.under) {
    fmt::print("\n");
    print_noise(result.under->noise);
  }
  print_budget(budget);
  print_notes(input);
}

}  // namespace

void setup_diagnose(const Command& app) {
  auto options = std::make_shared<DiagnoseCommand>();
  const Command command =
      app.add_subcommand("diagnose", "Find out which physical effect a model is missing");
  add_model_recordings(command, options->input);
  add_stated_noise(command, options->input);
  command.add_option("--list", options->list, "Candidates to list").capture_default_str();
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
