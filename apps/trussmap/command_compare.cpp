// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap compare: how far a model is from measurements, and where.
#include "commands.hpp"
#include "json_values.hpp"
#include "model_recordings.hpp"
#include "noise_output.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct CompareCommand {
  ModelRecordingsOptions input;
  std::size_t worst = 5;
  PageOptions page;
  std::string tolerance;
};

ordered_json legs_json(const Comparison& result) {
  ordered_json worst = ordered_json::array();
  for (const LegMisfit& leg : result.worst) {
    worst.push_back({{"from", leg.from},
                     {"to", leg.to},
                     {"t", leg.t},
                     {"chi2", leg.chi2},
                     {"dof", leg.dof},
                     {"stretch_error", leg.stretch_error},
                     {"orientation_error_rad", leg.orientation_error}});
  }
  return worst;
}

ordered_json routes_json(const Comparison& result) {
  ordered_json routes = ordered_json::array();
  for (const RouteMisfit& route : result.routes) {
    routes.push_back({{"from", route.from},
                      {"to", route.to},
                      {"traversals", route.traversals},
                      {"chi2", route.chi2},
                      {"force_per_m", route.force},
                      {"stretch_error", route.stretch_error},
                      {"orientation_error_rad", route.orientation_error}});
  }
  return routes;
}

ordered_json landmarks_json(const Comparison& result) {
  ordered_json landmarks = ordered_json::array();
  for (const LandmarkMisfit& one : result.worst_landmarks) {
    landmarks.push_back(
        {{"landmark", one.landmark}, {"sightings", one.sightings}, {"chi2", one.chi2}});
  }
  return landmarks;
}

ordered_json trends_json(const Comparison& result) {
  ordered_json trends = ordered_json::array();
  for (const Trend& trend : result.trends) {
    trends.push_back({{"residual", trend.kind},
                      {"against", trend.against},
                      {"channel", name_of(trend.effect.channel)},
                      {"shape", texts_of(trend.effect.shape)},
                      {"coefficients", trend.effect.coefficients},
                      {"score", trend.score},
                      {"dof", trend.dof},
                      {"p_value", trend.p_value},
                      {"p_adjusted", trend.p_adjusted},
                      {"size_rms", trend.size}});
  }
  return trends;
}

ordered_json sources_json(const Comparison& result) {
  ordered_json sources = ordered_json::array();
  for (const SourceCalibration& one : result.sources) {
    sources.push_back({{"source", one.source},
                       {"factor", one.factor},
                       {"sd", one.sd},
                       {"redundancy", one.redundancy}});
  }
  return sources;
}

ordered_json outliers_json(const Comparison& result) {
  ordered_json outliers = ordered_json::array();
  for (const Outlier& one : result.outliers) {
    outliers.push_back({{"what", one.what},
                        {"statistic", one.statistic},
                        {"dof", one.dof},
                        {"p_adjusted", one.p_adjusted}});
  }
  return outliers;
}

ordered_json json_of(const Comparison& result) {
  return {{"verdict", verdict_of(result)},
          {"chi2", result.chi2},
          {"dof", result.dof},
          {"coefficients_estimated", result.coefficients},
          {"p_value", result.p_value},
          {"legs", result.legs},
          {"landmarks", result.landmarks},
          {"heldout", held_out_json(result.held_out)},
          {"worst", legs_json(result)},
          {"routes", routes_json(result)},
          {"worst_landmarks", landmarks_json(result)},
          {"trends", trends_json(result)},
          {"noise", sources_json(result)},
          {"outliers", outliers_json(result)},
          {"advice", in_words(result.lacks)},
          {"warnings", result.warnings}};
}

void run_compare(const CompareCommand& options) {
  Progress progress({{"reading", 1}, {"fitting the map", 4}, {"comparing", 40}});
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  CompareOptions how = compare_options(options.input);
  how.fit.fit_effects = false;
  progress.next();
  const ModelFit fit = fit_model(input.recordings, input.model, how.fit);
  progress.next();
  const Comparison result = compare(input, fit, how);
  const std::vector<NoiseBudget> budget = noise_budget(input.recordings, input.model);
  const std::optional<Tolerance> tolerance = judged(options.tolerance, result.held_out);
  Files files;
  if (!options.input.json.empty()) {
    ordered_json report = json_of(result);
    report["noise_budget"] = budget_json(budget);
    report["sightings_used"] = sightings_json(result.sightings);
    report["notes"] = input.notes;
    add_tolerance(tolerance, report);
    files.emplace_back(options.input.json, report.dump(2) + "\n");
  }
  if (options.page.wanted()) {
    add_page(
        files,
        with_tolerance(
            with_drive(comparison_page(evidence_of(fit, result),
                                       subject_of(options.input.recordings, options.input.model)),
                       input.model.robot, input.recordings),
            tolerance),
        options.page, input.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}",
             comparison_text(result, input.model.noise, budget, options.worst, style_of(stdout)),
             notes_text(input.notes));
  end_by(tolerance);
}

}  // namespace

void setup_compare(const Command& app) {
  auto options = std::make_shared<CompareCommand>();
  const Command command = app.add_subcommand(
      "compare", "Compare a model with recordings: is it consistent, and where does it fail?");
  add_model_recordings(command, options->input);
  command.add_option("--worst", options->worst, "Legs and routes to list").capture_default_str();
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Survey and truth are used as measurements. A bar force is what a route pulls (+) or pushes\n"
      "(-) its landmarks with. JSON holds all legs, routes and trends.");
  command.callback([options] { run_compare(*options); });
}

}  // namespace trussmap::app
