// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap discover: diagnose, add and fit for as long as that is justified.
#include "commands.hpp"
#include "criticism/discovery.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "report/discovery_page.hpp"
#include "terminal.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"
#include "wording/effect_words.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct DiscoverOptions {
  ModelRecordingsOptions input;
  std::string out;
  double level = 0.05;
  std::size_t most = 6;
  PageOptions page;
};

ordered_json json(const DiscoveryStep& step) {
  ordered_json one = {{"added", nullptr},
                      {"chi2", step.chi2},
                      {"dof", step.dof},
                      {"heldout", held_out_json(step.held_out)}};
  if (step.added) {
    one["added"] = effect_json(*step.added);
    one["added"]["coefficients"] = step.added->coefficients;
    one["dropped"] = step.dropped;
    one["promised"] = {{"chi2_decrease", step.predicted_chi2},
                       {"arrival_rms_m", step.predicted.arrival_rms}};
    ordered_json rivals = ordered_json::array();
    for (const LookAlike& rival : step.look_alikes) {
      rivals.push_back(effect_json(rival.effect));
      rivals.back()["cosine"] = rival.cosine;
    }
    one["indistinguishable_from"] = rivals;
  }
  return one;
}

ordered_json json(const Discovery& result) {
  ordered_json steps = ordered_json::array();
  for (const DiscoveryStep& step : result.steps) steps.push_back(json(step));
  ordered_json effects = ordered_json::array();
  for (const EffectEstimate& one : result.fit.effects) effects.push_back(estimate_json(one));
  return {{"steps", steps},
          {"stopped", result.stopped},
          {"verdict", result.consistent ? "consistent" : "unexplained misfit"},
          {"effects", effects},
          {"warnings", result.fit.adjustment.warnings}};
}

std::string verdict(const Discovery& result) {
  const auto added =
      std::count_if(result.steps.begin(), result.steps.end(),
                    [](const DiscoveryStep& step) { return step.added.has_value(); });
  const std::string found = added == 0   ? "nothing found, the model stays as it is"
                            : added == 1 ? "one effect found"
                                         : fmt::format("{} effects found, one by one", added);
  return result.consistent
             ? verdict_text(Mood::good, fmt::format("consistent: {}; {}", found, result.stopped))
             : verdict_text(Mood::bad,
                            fmt::format("unexplained misfit: {}; {}", found, result.stopped));
}

void print(const Discovery& result) {
  fmt::print("{}\n", verdict(result));
  for (const EffectEstimate& one : result.fit.effects) {
    fmt::print("  {}: {}\n", one.effect.name, in_words(one.effect, one.sd));
  }
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right,
                   Align::right, Align::right},
                  {},
                  true,
                  2};
  table.rows.push_back({"model", "chi2", "dof", "predicted", "held out [mm]", "predicted", "legs"});
  for (const DiscoveryStep& step : result.steps) {
    std::string name = step.added ? "+ " + step.added->name : "as given";
    for (const std::string& dropped : step.dropped) name += ", - " + dropped;
    const double before =
        &step == &result.steps.front() ? step.chi2 : (&step - 1)->chi2 - step.predicted_chi2;
    table.rows.push_back(
        {name, fmt::format("{:.1f}", step.chi2), fmt::format("{}", step.dof),
         step.added ? fmt::format("{:.1f}", before) : "-",
         step.held_out.legs.empty() ? "-" : fmt::format("{:.1f}", 1e3 * step.held_out.arrival_rms),
         step.added ? fmt::format("{:.1f}", 1e3 * step.predicted.arrival_rms) : "-",
         fmt::format("{}", step.held_out.legs.size())});
  }
  fmt::print("\n{}", table_text(table));
  for (const DiscoveryStep& step : result.steps) {
    for (const LookAlike& rival : step.look_alikes) {
      fmt::print("  instead of {} it could be: {} ({} x {}), cosine {:.3f}\n", step.added->name,
                 rival.effect.name, name_of(rival.effect.channel),
                 fmt::join(texts_of(rival.effect.shape), ", "), rival.cosine);
    }
  }
  for (const std::string& warning : result.fit.adjustment.warnings) {
    fmt::print("{}", warning_text(warning));
  }
}

/// The models between the one given and the one found, fitted anew.
std::vector<FittedStep> models_between(const ModelRecordings& input, const Discovery& result,
                                       const ModelFit& given, const ModelFitOptions& options,
                                       const ComparisonOptions& compared) {
  std::vector<FittedStep> models;
  Model model = given.model;
  ModelFitOptions how = options;
  how.near = &given;
  for (std::size_t k = 1; k + 1 < result.steps.size(); ++k) {
    const DiscoveryStep& step = result.steps[k];
    model.effects.push_back(*step.added);
    std::erase_if(model.effects, [&step](const Effect& one) {
      return std::find(step.dropped.begin(), step.dropped.end(), one.name) != step.dropped.end();
    });
    const ModelFit fit = fit_model(input.recordings, model, how);
    const ScoreTest tests(fit);
    models.push_back({step_name(step), fitted_model(input.recordings, fit, tests, compared)});
  }
  return models;
}

Page page_of(const ModelRecordings& input, const Discovery& result, const DiagnosisOptions& how,
             const DiscoverOptions& options) {
  const ComparisonOptions compared = comparison_options(options.input);
  const ModelFitOptions given = fit_options(how);
  const ModelFit before = fit_model(input.recordings, input.model, given);
  const ScoreTest tests(before);
  const ScoreTest after(result.fit);
  const AddedEffects added = added_effects(result);
  DiscoveryPictures pictures;
  pictures.given = fitted_model(input.recordings, before, tests, compared);
  pictures.between = models_between(input, result, before, given, compared);
  pictures.found = fitted_model(input.recordings, result.fit, after, compared);
  pictures.effects = fitted_effects(before, added.estimates, added.rivals);
  pictures.trends = trend_pictures(pictures.found.comparison, result.fit, after);
  pictures.tables = diagnosis_tables(result.last, after.context(), pictures.effects);
  return discovery_page(result, pictures,
                        subject_of(options.input.recordings, options.input.model));
}

/// Tells how far a discovery is: as if one effect were found, and one more whenever there is.
class Told {
 public:
  explicit Told(bool page) : progress_(steps(page)) { progress_.next(); }

  void part(const std::string& what) {
    const bool fits = what.starts_with("fitting \"");
    if (fits && fits_) {  // a rival, in the same step
      progress_.say(what);
      return;
    }
    fits_ = fits;
    if (fits && ++found_ > 1) progress_.insert({kAdding, kLooking});
    progress_.next();
    if (fits) progress_.say(what);
  }
  void page() {
    // Where nothing was found, the two steps of an effect are passed over.
    for (int k = found_ == 0 ? 0 : 2; k < 3; ++k) progress_.next();
  }
  void end() { progress_.end(); }

 private:
  static std::vector<ProgressStep> steps(bool page) {
    std::vector<ProgressStep> result{
        {"reading", 0.5}, {"fitting the model given", 2.5}, kLooking, kAdding, kLooking};
    if (page) result.push_back({"comparing the models", 60});
    return result;
  }

  static inline const ProgressStep kLooking{"looking for what is missing", 50};
  static inline const ProgressStep kAdding{"fitting an effect", 20};
  Progress progress_;
  bool fits_ = false;
  int found_ = 0;
};

void run_discover(const DiscoverOptions& options) {
  Told told(options.page.wanted());
  const ModelRecordings input = read_model_recordings(options.input);
  DiscoveryOptions how;
  how.diagnosis.problem = problem_options(options.input);
  how.diagnosis.legs = options.input.legs;
  how.diagnosis.gate = gate_of(options.input);
  how.diagnosis.level = options.level;
  how.most_effects = options.most;
  how.progress = [&told](const std::string& what) { told.part(what); };
  Discovery result = discover(input.recordings, input.model, how);
  result.last.advice = advice_on(input.recordings, result.fit.model, how.diagnosis.problem);
  told.page();
  Files files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(result.fit.model));
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, json(result).dump(2) + "\n");
  }
  if (options.page.wanted()) {
    add_page(files, page_of(input, result, how.diagnosis, options), options.page);
  }
  write_files(files);
  told.end();
  print(result);
}

}  // namespace

void setup_discover(CLI::App& app) {
  auto options = std::make_shared<DiscoverOptions>();
  CLI::App* command = app.add_subcommand(
      "discover", "Find the effects that a model is missing, add and fit them, one by one");
  add_model_recordings(*command, options->input);
  command->add_option("--out", options->out, "Write the model found (TOML)")->type_name("FILE");
  command->add_option("--level", options->level, "Chance of adding an effect where none is missing")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  command->add_option("--most", options->most, "Effects to add at most")->capture_default_str();
  add_html_option(*command, options->page);
  add_plots_option(*command, options->page);
  command->footer(
      "The ladder has one line per model, always over the same held-out legs. \"Predicted\" is\n"
      "what the diagnosis expected before the fit. The page (--html) shows it with each effect's\n"
      "curve.");
  command->callback([options] { run_discover(*options); });
}

}  // namespace trussmap::app
