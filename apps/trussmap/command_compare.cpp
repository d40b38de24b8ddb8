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
#include "trussmap/compare.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <memory>
#include <numbers>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct CompareCommand {
  ModelRecordingsOptions input;
  std::size_t worst = 5;
  PageOptions page;
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

ordered_json json(const Comparison& result) {
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

std::string size_text(const Trend& trend) {
  if (trend.unit.empty()) return fmt::format("{:.2g} %", 100.0 * trend.size);
  if (trend.unit == "rad") return fmt::format("{:.2g} deg", trend.size * 180.0 / std::numbers::pi);
  if (trend.unit == "m") return fmt::format("{:.2g} mm", 1e3 * trend.size);
  return fmt::format("{:.2g} {}", trend.size, trend.unit);
}

std::string signed_percent(double value) {
  return fmt::format("{:+.2f}", 100.0 * value);
}
std::string signed_mrad(double value) {
  return fmt::format("{:+.1f}", 1e3 * value);
}

void print_trends(const Comparison& result) {
  constexpr std::size_t kMost = 6;
  TextTable table{
      {Align::left, Align::left, Align::right, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"residual of", "goes with", "explains chi2", "size (rms)", "p, adjusted"});
  for (const Trend& trend : result.trends) {
    if (trend.p_adjusted > kSignificance || table.rows.size() > kMost) continue;
    table.rows.push_back({trend.kind, trend.against == "all" ? "everything alike" : trend.against,
                          fmt::format("{:.1f}", trend.score), size_text(trend),
                          probability_text(trend.p_adjusted)});
  }
  if (table.rows.size() == 1) {
    fmt::print("\nNo residual has a trend, of {} looked for.\n", result.trends.size());
    return;
  }
  fmt::print("\nWhere the residuals go (of {} trends looked for)\n{}", result.trends.size(),
             table_text(table));
}

void print_worst(const Comparison& result, std::size_t count) {
  TextTable legs{
      {Align::left, Align::right, Align::right, Align::right, Align::right}, {}, true, 2};
  legs.rows.push_back({"leg", "t [s]", "chi2 (values)", "stretch [%]", "turned [mrad]"});
  for (std::size_t k = 0; k < std::min(count, result.worst.size()); ++k) {
    const LegMisfit& leg = result.worst[k];
    legs.rows.push_back({leg.from.empty() ? "-" : leg.from + " - " + leg.to,
                         fmt::format("{:.1f}", leg.t),
                         fmt::format("{:.1f} ({})", leg.chi2, leg.dof),
                         signed_percent(leg.stretch_error), signed_mrad(leg.orientation_error)});
  }
  if (legs.rows.size() > 1) fmt::print("\nWorst legs\n{}", table_text(legs));
  TextTable routes{
      {Align::left, Align::right, Align::right, Align::right, Align::right, Align::right},
      {},
      true,
      2};
  routes.rows.push_back(
      {"route", "driven", "chi2", "bar force [1/m]", "stretch [%]", "turned [mrad]"});
  for (std::size_t k = 0; k < std::min(count, result.routes.size()); ++k) {
    const RouteMisfit& route = result.routes[k];
    routes.rows.push_back({route.from + " - " + route.to, fmt::format("{}", route.traversals),
                           fmt::format("{:.1f}", route.chi2), fmt::format("{:+.0f}", route.force),
                           signed_percent(route.stretch_error),
                           signed_mrad(route.orientation_error)});
  }
  if (routes.rows.size() > 1) fmt::print("\nMost strained routes\n{}", table_text(routes));
}

void print_sources(const Comparison& result, const Noise& noise) {
  constexpr double kSure = 3.0;
  constexpr double kLikely = 2.0;
  TextTable table{{Align::left, Align::right, Align::left}, {}, true, 2};
  table.rows.push_back({"noise of", "true/stated", "verdict"});
  for (const SourceCalibration& one : result.sources) {
    const double off = (one.factor - 1.0) / one.sd;
    table.rows.push_back({one.source, fmt::format("{:.2f} +- {:.2f}", one.factor, one.sd),
                          off > kSure      ? "stated too small, or an effect is missing"
                          : off < -kSure   ? "stated too large"
                          : off > kLikely  ? "perhaps stated too small"
                          : off < -kLikely ? "perhaps stated too large"
                                           : "as stated"});
  }
  for (const NoiseProcess& one : noise.processes) {
    table.rows.push_back({fmt::format("{}, {}", name_of(one.channel), name_of(one.process)), "-",
                          "taken as stated (fit --noise estimates it)"});
  }
  if (table.rows.size() > 1) fmt::print("\nNoise\n{}", table_text(table));
}

void print_outliers(const Comparison& result, std::size_t count) {
  TextTable table{{Align::left, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"contradicted by all others", "chi2 (values)", "p, adjusted"});
  for (std::size_t k = 0; k < std::min(count, result.outliers.size()); ++k) {
    const Outlier& one = result.outliers[k];
    table.rows.push_back({one.what, fmt::format("{:.1f} ({})", one.statistic, one.dof),
                          probability_text(one.p_adjusted)});
  }
  if (table.rows.size() > 1) fmt::print("\nOutliers\n{}", table_text(table));
}

void print(const Comparison& result, const Noise& noise, const CompareCommand& options) {
  const Mood mood = !result.consistent() ? Mood::bad : result.tested() ? Mood::good : Mood::doubt;
  fmt::print("{}\n", verdict_text(mood, verdict_in_words(result)));
  fmt::print("  {}, p {}; {} legs, {} landmarks\n  {}\n",
             fit_in_words(result.chi2, result.dof, result.coefficients),
             probability_text(result.p_value), result.legs, result.landmarks,
             in_words(result.held_out));
  print_trends(result);
  if (!result.consistent()) print_worst(result, options.worst);
  print_outliers(result, options.worst);
  print_sources(result, noise);
  if (!result.lacks.empty()) fmt::print("\nWhat these data lack\n");
  for (const std::string& line : in_words(result.lacks)) fmt::print("  {}\n", line);
  for (const std::string& warning : result.warnings) fmt::print("{}", warning_text(warning));
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
  const Comparison result = compare(input.recordings, fit, how);
  const std::vector<NoiseBudget> budget = noise_budget(input.recordings, input.model);
  Files files;
  if (!options.input.json.empty()) {
    ordered_json report = json(result);
    report["noise_budget"] = budget_json(budget);
    report["notes"] = input.notes;
    files.emplace_back(options.input.json, report.dump(2) + "\n");
  }
  if (options.page.wanted()) {
    add_page(files,
             with_drive(comparison_page(evidence_of(fit, result),
                                        subject_of(options.input.recordings, options.input.model)),
                        input.model.robot, input.recordings),
             options.page);
  }
  files.write();
  progress.end();
  print(result, input.model.noise, options);
  print_budget(budget);
  print_notes(input);
}

}  // namespace

void setup_compare(const Command& app) {
  auto options = std::make_shared<CompareCommand>();
  const Command command = app.add_subcommand(
      "compare", "Compare a model with recordings: is it consistent, and where does it fail?");
  add_model_recordings(command, options->input);
  command.add_option("--worst", options->worst, "Legs and routes to list").capture_default_str();
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Survey and truth are used as measurements. A bar force is what a route pulls (+) or pushes\n"
      "(-) its landmarks with. JSON holds all legs, routes and trends.");
  command.callback([options] { run_compare(*options); });
}

}  // namespace trussmap::app
