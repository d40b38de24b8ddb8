// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap diagnose: which physical effect is missing from a model.
#include "commands.hpp"
#include "criticism/diagnosis.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "report/diagnosis_page.hpp"
#include "terminal.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"
#include "wording/effect_words.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct DiagnoseOptions {
  ModelRecordingsOptions input;
  double level = 0.05;
  std::size_t list = 8;
  PageOptions page;
};

ordered_json json(const HeldOutMetrics& figures) {
  return {{"arrival_rms_m", figures.arrival_rms},
          {"stretch_error", figures.stretch_error},
          {"orientation_error_rad", figures.orientation_error}};
}

ordered_json json(const Finding& finding) {
  const Effect& effect = finding.candidate.effect;
  ordered_json one = effect_json(effect);
  one["score"] = finding.score;
  one["dof"] = finding.dof;
  one["p_value"] = finding.p_value;
  one["p_adjusted"] = finding.p_adjusted;
  one["status"] = name_of(finding.status);
  one["coefficients"] = numbers_or_null(effect.coefficients);
  one["sd"] = numbers_or_null(finding.sd);
  one["smallest_detectable"] = numbers_or_null(finding.minimal_detectable);
  one["heldout"] = json(finding.held_out);
  one["log_evidence"] = finding.evidence;
  one["tried"] = finding.tried;
  ordered_json rivals = ordered_json::array();
  for (const LookAlike& rival : finding.look_alikes) {
    rivals.push_back(effect_json(rival.effect));
    rivals.back()["cosine"] = rival.cosine;
  }
  one["indistinguishable_from"] = rivals;
  return one;
}

ordered_json json(const Diagnosis& result) {
  const char* verdict = result.verdict == Diagnosis::Verdict::missing ? "missing"
                        : result.verdict == Diagnosis::Verdict::nothing_missing
                            ? "nothing missing"
                            : "unexplained misfit";
  ordered_json candidates = ordered_json::array();
  for (const Finding& finding : result.findings) candidates.push_back(json(finding));
  ordered_json unobservable = ordered_json::array();
  for (const Unobservable& one : result.unobservable) {
    unobservable.push_back(effect_json(one.effect));
    unobservable.back()["why"] = one.why;
    unobservable.back()["remedy"] = one.remedy;
  }
  ordered_json noise = ordered_json::array();
  for (const NoiseTest& one : result.noise) {
    noise.push_back({{"law", one.law},
                     {"score", one.score},
                     {"dof", one.dof},
                     {"p_adjusted", one.p_adjusted},
                     {"size", one.size},
                     {"unit", one.unit},
                     {"in_words", one.in_words}});
  }
  ordered_json outliers = ordered_json::array();
  for (const EventTest& one : result.events) {
    outliers.push_back({{"kind", one.kind},
                        {"name", one.name},
                        {"score", one.score},
                        {"dof", one.dof},
                        {"p_adjusted", one.p_adjusted},
                        {"in_words", one.in_words}});
  }
  return {{"verdict", verdict},
          {"missing", result.missing},
          {"p_value", result.p_value},
          {"chi2", result.chi2},
          {"dof", result.dof},
          {"heldout", held_out_json(result.held_out)},
          {"tried", result.tried},
          {"candidates", candidates},
          {"noise", noise},
          {"outliers", outliers},
          {"advice", result.advice},
          {"next_drive", result.next_drive},
          {"unobservable", unobservable},
          {"warnings", result.warnings}};
}

std::string length(double metres) {
  return metres < 1.0 ? fmt::format("{:.1f} mm", 1e3 * metres) : fmt::format("{:.2f} m", metres);
}

void print_verdict(const Diagnosis& result) {
  if (result.verdict == Diagnosis::Verdict::nothing_missing) {
    const std::string text = fmt::format(
        "nothing missing: none of {} effects tried explains more than chance", result.tried);
    fmt::print("{}\n", verdict_text(Mood::good, text));
  } else if (result.verdict == Diagnosis::Verdict::unexplained_misfit) {
    const std::string text = fmt::format(
        "unexplained misfit: the model's noise does not allow these errors (p {}), and none of {} "
        "effects tried explains them",
        probability_text(result.p_value), result.tried);
    fmt::print("{}\n", verdict_text(Mood::bad, text));
  }
  for (const Finding& one : result.findings) {
    if (one.status != Status::missing && one.status != Status::negligible) continue;
    Effect effect = one.candidate.effect;
    effect.coefficients = one.joint;
    const Mood mood = one.status == Status::missing ? Mood::bad : Mood::doubt;
    fmt::print("{}\n",
               verdict_text(mood, fmt::format("{}: {}; {}", name_of(one.status), effect.name,
                                              in_words(effect, one.joint_sd))));
    for (const LookAlike& rival : one.look_alikes) {
      fmt::print("  looks the same here: {} ({} x {}), cosine {:.3f}\n", rival.effect.name,
                 name_of(rival.effect.channel), fmt::join(texts_of(rival.effect.shape), ", "),
                 rival.cosine);
    }
  }
  if (!result.missing.empty() && !result.held_out.legs.empty()) {
    const bool several = result.findings.size() > 1 && !result.findings[1].joint.empty();
    const char* what = several ? "them" : "it";
    fmt::print("  without {} legs end {} off, with {} {} (rms of {} held-out legs, predicted)\n",
               what, length(result.held_out.arrival_rms), what,
               length(result.with_missing.arrival_rms), result.held_out.legs.size());
  }
  if (!result.next_drive.empty()) fmt::print("  to tell them apart: {}\n", result.next_drive);
}

/// Noise laws and single events that are significant.
void print_others(const Diagnosis& result, std::size_t count) {
  constexpr double kLevel = 0.05;
  std::size_t shown = 0;
  for (const NoiseTest& one : result.noise) {
    if (one.p_adjusted >= kLevel || shown >= 2) continue;
    if (shown++ == 0) fmt::print("\nMore noise than the model states\n");
    fmt::print("  {}: {} (score {:.1f}, p {})\n", one.law, one.in_words, one.score,
               probability_text(one.p_adjusted));
  }
  shown = 0;
  for (const EventTest& one : result.events) {
    if (one.p_adjusted >= kLevel || shown >= count) continue;
    if (shown++ == 0) fmt::print("\nSingle events\n");
    fmt::print("  {} {}: {} (score {:.1f}, p {})\n", one.kind, one.name, one.in_words, one.score,
               probability_text(one.p_adjusted));
  }
}

/// What is significant by itself and yet absent is explained by what comes before it.
std::string status_text(const Finding& one) {
  if (one.status == Status::absent && one.p_adjusted < 0.05) return "explained by the above";
  return std::string(name_of(one.status));
}

void print(const Diagnosis& result, const DiagnoseOptions& options) {
  constexpr std::size_t kWidestCell = 36;  // characters; --json has all of it
  print_verdict(result);
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::right, Align::left},
                  {},
                  true,
                  2};
  table.rows.push_back({"best candidates", "channel x shape", "chi2 less (dof)", "p, adjusted",
                        "held out [mm]", "status"});
  for (std::size_t k = 0; k < std::min(options.list, result.findings.size()); ++k) {
    const Finding& one = result.findings[k];
    const Effect& effect = one.candidate.effect;
    table.rows.push_back({shortened(effect.name, kWidestCell),
                          shortened(fmt::format("{} x {}", name_of(effect.channel),
                                                fmt::join(texts_of(effect.shape), ", ")),
                                    kWidestCell),
                          fmt::format("{:.1f} ({})", one.score, one.dof),
                          probability_text(one.p_adjusted),
                          fmt::format("{:.1f}", 1e3 * one.held_out.arrival_rms), status_text(one)});
  }
  fmt::print("\nchi2 {:.1f}, dof {}; {} tests\n{}", result.chi2, result.dof, result.tried,
             table_text(table));
  print_others(result, options.list);
  if (!result.unobservable.empty()) fmt::print("\nNot to be seen in these data\n");
  for (const Unobservable& one : result.unobservable) {
    fmt::print("  {}: {}; {}\n", one.effect.name, one.why, one.remedy);
  }
  if (!result.advice.empty()) fmt::print("\nWhat these data lack\n");
  for (const std::string& line : result.advice) fmt::print("  {}\n", line);
  for (const std::string& warning : result.warnings) fmt::print("{}", warning_text(warning));
}

/// The model with what is missing put in and fitted; with the first alone where not all can be.
std::optional<ModelFit> fit_with(const std::vector<const Finding*>& missing,
                                 const ModelRecordings& input, const ModelFit& fit,
                                 const DiagnosisOptions& how) {
  ModelFitOptions more = fit_options(how);
  more.near = &fit;
  for (std::size_t count = missing.size(); count > 0; count = count > 1 ? 1 : 0) {
    Model model = fit.model;
    for (std::size_t k = 0; k < count; ++k) {
      model.effects.push_back(missing[k]->candidate.effect);
    }
    try {
      return fit_model(input.recordings, model, more);
    } catch (const SolveError&) {
      continue;
    }
  }
  return std::nullopt;
}

Page page_of(const ModelRecordings& input, const ModelFit& fit, const Diagnosis& result,
             const DiagnosisOptions& how, const DiagnoseOptions& options) {
  const ComparisonOptions compared = comparison_options(options.input);
  const ScoreTest tests(fit);
  DiagnosisPictures pictures;
  pictures.given = fitted_model(input.recordings, fit, tests, compared);
  pictures.trends = trend_pictures(pictures.given.comparison, fit, tests);
  pictures.tables = diagnosis_tables(result, tests.context());
  const std::vector<const Finding*> missing = found_by(result);
  const std::optional<ModelFit> with = fit_with(missing, input, fit, how);
  std::vector<EffectEstimate> estimates;
  std::vector<std::vector<LookAlike>> rivals;
  for (std::size_t k = 0; k < missing.size(); ++k) {
    const std::size_t place = fit.effects.size() + k;
    estimates.push_back(with && place < with->effects.size()
                            ? with->effects[place]
                            : EffectEstimate{missing[k]->candidate.effect, missing[k]->sd, {}});
    rivals.push_back(missing[k]->look_alikes);
  }
  pictures.effects = fitted_effects(fit, estimates, rivals);
  if (with) {
    const ScoreTest after(*with);
    pictures.with = fitted_model(input.recordings, *with, after, compared);
  }
  return diagnosis_page(result, pictures,
                        subject_of(options.input.recordings, options.input.model));
}

void run_diagnose(const DiagnoseOptions& options) {
  std::vector<ProgressStep> steps{
      {"reading", 0.5}, {"fitting the map", 2.5}, {"looking for what is missing", 50}};
  if (options.page.wanted()) steps.push_back({"comparing with what is missing", 50});
  Progress progress(steps);
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  DiagnosisOptions how;
  how.problem = problem_options(options.input);
  how.legs = options.input.legs;
  how.gate = gate_of(options.input);
  how.level = options.level;
  progress.next();
  const ModelFit fit = fit_model(input.recordings, input.model, fit_options(how));
  progress.next();
  Diagnosis result = diagnose(input.recordings, fit, how);
  result.advice = advice_on(input.recordings, input.model, how.problem);
  Files files;
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, json(result).dump(2) + "\n");
  }
  progress.next();
  if (options.page.wanted()) {
    add_page(files, page_of(input, fit, result, how, options), options.page);
  }
  write_files(files);
  progress.end();
  print(result, options);
}

}  // namespace

void setup_diagnose(CLI::App& app) {
  auto options = std::make_shared<DiagnoseOptions>();
  CLI::App* command =
      app.add_subcommand("diagnose", "Find out which physical effect a model is missing");
  add_model_recordings(*command, options->input);
  command->add_option("--level", options->level, "Chance of naming an effect where none is missing")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  command->add_option("--list", options->list, "Candidates to list")->capture_default_str();
  add_html_option(*command, options->page);
  add_plots_option(*command, options->page);
  command->footer(
      "Tries the whole catalogue, and every channel against every variable and covariate. "
      "Missing:\n"
      "named by these data. Absent: would have been seen at any size that matters. Cannot tell:\n"
      "these data could not show it, or another effect looks the same. The page (--html) has what\n"
      "is missing, its rivals, the next drive, and the best change to each part of the robot.");
  command->callback([options] { run_diagnose(*options); });
}

}  // namespace trussmap::app
