// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "plot/fit_charts.hpp"
#include "report/fit_sections.hpp"
#include "report/noise_verdict.hpp"
#include "report/page_words.hpp"
#include "report/result_rows.hpp"
#include "report/robot_off.hpp"
#include "text/number_text.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr std::size_t kTrendsNamed = 3;
constexpr std::size_t kRoutes = 30;

PageTable route_table(const Comparison& result) {
  PageTable table;
  table.caption = fmt::format(
      "Routes by strain (the first {} of {}); bar force: how hard "
      "measurements pull the landmarks together; stretch: measured too "
      "long (+); turned: too far to the left (+)",
      std::min(kRoutes, result.routes.size()), result.routes.size());
  table.headings = {"from",        "to",           "driven", "chi\u00b2", "bar force [1/m]",
                    "stretch [%]", "turned [mrad]"};
  table.texts = 2;
  for (std::size_t k = 0; k < std::min(kRoutes, result.routes.size()); ++k) {
    const RouteMisfit& route = result.routes[k];
    table.rows.push_back({route.from, route.to, std::to_string(route.traversals),
                          fmt::format("{:.1f}", route.chi2),
                          text::signed_fixed_text(route.force, 0),
                          text::signed_fixed_text(100.0 * route.stretch_error, 2),
                          text::signed_fixed_text(1000.0 * route.orientation_error, 1)});
  }
  return table;
}

PageTable outlier_table(const Comparison& result) {
  PageTable table;
  table.caption = "Measurements that all others contradict";
  table.headings = {"what", "chi\u00b2", "values", "p, adjusted"};
  for (const Outlier& one : result.outliers) {
    if (table.rows.size() == kRoutes) break;
    table.rows.push_back({one.what, fmt::format("{:.1f}", one.statistic), std::to_string(one.dof),
                          probability_text(one.p_adjusted)});
  }
  return table;
}

/// The trend to name, where one is clear.
const Trend* telling_trend(const Comparison& result) {
  const bool clear = !result.trends.empty() && result.tells(result.trends.front());
  return clear ? &result.trends.front() : nullptr;
}

/// "the compass error goes with heading (3.1°)".
std::string trend_words(const Trend& trend) {
  return fmt::format("the {} error {}, by {} (rms)", trend.kind,
                     trend.against == "all"
                         ? "is everywhere alike"
                         : "goes with " + wording::variable_in_words(trend.against),
                     wording::shown(trend.size, trend.unit));
}

std::string page_verdict(const Comparison& result) {
  const bool legs = !result.held_out.legs.empty();
  const std::string held = legs ? distance_text(result.held_out.arrival_rms) : "";
  if (result.consistent() && !result.tested()) {
    return "Nothing contradicts the model, " + objection_in_words(result) + ".";
  }
  if (result.consistent()) {
    return "The model explains these measurements" +
           (!legs ? std::string(" to within its noise.")
            : as_good_as_noise(result.held_out)
                ? ": legs end " + held + " off, as its noise allows."
                : ": legs end " + held + " off.");
  }
  if (result.objection == Objection::effect) {
    return fmt::format("Missing: {}.{}", result.missing, legs ? " Legs end " + held + " off." : "");
  }
  if (const Trend* first = telling_trend(result)) {
    return fmt::format("The model does not explain these errors: {}.{}", trend_words(*first),
                       legs ? " Legs end " + held + " off." : "");
  }
  return fmt::format("The model does not explain these errors{}: {}.",
                     legs ? ", legs end " + held + " off" : "", objection_in_words(result));
}

std::vector<std::string> missing_rows(const Comparison& result) {
  if (result.consistent()) {
    return {result.tested() ? "Nothing that these measurements show."
                            : "Unknown: too little was measured to contradict any model."};
  }
  if (result.objection == Objection::effect) return {capitalised(result.missing) + "."};
  if (result.objection == Objection::change) return {"A coefficient that changes."};
  return {"Something, and unknown what: compare looks for no effects, diagnose does."};
}

std::vector<std::string> large_rows(const Comparison& result) {
  std::vector<std::string> rows;
  if (!result.consistent()) rows.push_back(capitalised(objection_in_words(result)) + ".");
  if (const Trend* first = telling_trend(result)) {
    rows.push_back(
        fmt::format("{}; its standard error is unknown here.", capitalised(trend_words(*first))));
  }
  if (rows.empty()) rows.emplace_back("Nothing stands out of the noise.");
  return rows;
}

std::vector<std::string> otherwise_rows(const Comparison& result) {
  std::vector<std::string> trends;
  for (const Trend& one : result.trends) {
    if (!result.tells(one) || trends.size() == kTrendsNamed) break;
    if (&one != &result.trends.front()) trends.push_back(trend_words(one));
  }
  std::vector<std::string> rows;
  if (!trends.empty()) rows.push_back(capitalised(listed(trends)) + ".");
  const std::string noisy = noisier_than_stated(result);
  if (!result.consistent() && !noisy.empty()) {
    rows.push_back(fmt::format("Noise that is stated too small: {} what is stated.", noisy));
  }
  if (!result.outliers.empty()) {
    rows.push_back("A wrong measurement: all others contradict " + result.outliers.front().what +
                   ".");
  }
  if (rows.empty()) {
    rows.emplace_back(result.consistent()
                          ? "An effect too small to be seen: diagnose says how large it may be."
                          : "Unknown: compare tries no effects, diagnose does.");
  }
  return rows;
}

std::vector<std::string> next_rows(const Comparison& result) {
  if (!result.consistent()) {
    return {
        "Give trussmap diagnose the same recordings and model. It names the effect behind the "
        "strongest trend, how large it is, what else it could be, and what to drive to tell."};
  }
  if (!result.lacks.empty()) return {advised_drive(advice_on(result.lacks.front()))};
  return {"Use the model."};
}

ResultRows rows_on(const ModelEvidence& model) {
  const Comparison& result = model.comparison;
  return {missing_rows(result),
          large_rows(result),
          {fmt::format("Errors as large arise from noise alone, were the model right, with "
                       "probability {} ({} degrees of freedom, {} legs, {} landmarks).",
                       chance_text(result.p_value), result.dof, result.legs, result.landmarks)},
          off_sentences(model),
          otherwise_rows(result),
          next_rows(result)};
}

PageSection map_section(const ModelEvidence& model) {
  PageSection section = maps_section("Where legs end off", {{"routes by how far off", model}});
  if (!model.comparison.held_out.legs.empty()) {
    std::get<ChartRow>(section.blocks.front())
        .push_back(plot::held_out_chart("held-out", {{"", model.comparison.held_out}}));
  }
  return section;
}

PageSection routes_section(const ModelEvidence& model) {
  const Comparison& result = model.comparison;
  PageSection section = legs_section("Legs and routes", result);
  section.details.emplace_back(
      ChartRow{plot::truss_chart("truss", "Map with the forces in its bars", model.map,
                                 result.routes, plot::loudest_force(result))});
  if (!result.routes.empty()) section.details.emplace_back(route_table(result));
  if (!result.outliers.empty()) section.details.emplace_back(outlier_table(result));
  return section;
}

}  // namespace

Page comparison_page(const ComparisonEvidence& evidence, const std::string& subject) {
  const Comparison& result = evidence.model.comparison;
  PageContent page;
  page.command = "compare";
  page.subject = subject;
  page.tone = !result.consistent() ? Tone::bad : result.tested() ? Tone::good : Tone::neutral;
  page.verdict = with_judged(page_verdict(result), result.sightings);
  page.answers = answers_of(rows_on(evidence.model));
  for (const std::string& line : result.warnings) {
    page.notes.push_back(capitalised(typeset(line)) + ".");
  }
  page.sections = {map_section(evidence.model),
                   trend_section("What the errors go with", result, evidence.trends),
                   noise_section({{"as given", evidence.model}}), routes_section(evidence.model)};
  close_tables(page);
  return page;
}

}  // namespace trussmap
