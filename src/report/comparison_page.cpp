// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/comparison_page.hpp"

#include "plot/fit_charts.hpp"
#include "report/diagnosis_tables.hpp"
#include "report/fit_sections.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kWorst = 12;
constexpr std::size_t kRoutes = 30;
constexpr double kTelling = 0.05;

std::string against_words(const Trend& trend) {
  return trend.against == "all" ? "everything alike" : trend.against;
}

PageTable route_table(const Comparison& result) {
  PageTable table;
  table.caption = fmt::format("Routes by strain (the first {} of {})",
                              std::min(kRoutes, result.routes.size()), result.routes.size());
  table.headings = {"from",        "to",           "driven", "chi\u00b2", "bar force [1/m]",
                    "stretch [%]", "turned [mrad]"};
  table.texts = 2;
  for (std::size_t k = 0; k < std::min(kRoutes, result.routes.size()); ++k) {
    const RouteMisfit& route = result.routes[k];
    table.rows.push_back({route.from, route.to, std::to_string(route.traversals),
                          fmt::format("{:.1f}", route.chi2), fmt::format("{:+.0f}", route.force),
                          fmt::format("{:+.2f}", 100.0 * route.stretch_error),
                          fmt::format("{:+.1f}", 1000.0 * route.orientation_error)});
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

}  // namespace

std::vector<TrendPicture> trend_pictures(const Comparison& comparison, const ModelFit& fit,
                                         const ScoreTest& tests) {
  std::vector<TrendPicture> pictures;
  std::set<std::string> seen;
  for (const Trend& trend : comparison.trends) {  // strongest first
    const std::string variable = natural_variable(trend.effect);
    if (variable.empty() || seen.contains(variable)) continue;
    Response response = response_along(variable, trend.effect, fit, tests);
    if (response.bins.empty()) continue;
    seen.insert(variable);
    pictures.push_back({trend, std::move(response)});
  }
  return pictures;
}

std::string comparison_verdict(const Comparison& result) {
  const std::string held = result.held_out.legs.empty()
                               ? ""
                               : fmt::format("{:.0f} mm", 1000.0 * result.held_out.arrival_rms);
  if (result.consistent) {
    return "The model explains these measurements" +
           (held.empty() ? std::string(" to within its noise.")
                         : ": legs that it has not seen end " + held +
                               " off, as its noise lets one expect.");
  }
  std::string text = fmt::format(
      "The model does not explain these measurements: errors are {:.1f} times what its "
      "noise allows",
      std::sqrt(result.misfit()));
  if (!held.empty()) text += ", and legs that it has not seen end " + held + " off";
  text += ".";
  if (!result.trends.empty() && result.trends.front().p_adjusted < kTelling) {
    const Trend& first = result.trends.front();
    text += fmt::format(
        " Most telling: the {} error{} ({}).", first.kind,
        first.against == "all" ? ", everywhere alike" : " goes with " + against_words(first),
        shown(first.size, first.unit));
  }
  return text;
}

Page comparison_page(const FittedModel& model, const std::vector<TrendPicture>& trends,
                     const std::string& subject) {
  const Comparison& result = model.comparison;
  Page page;
  page.command = "compare";
  page.subject = subject;
  page.tone = result.consistent ? Tone::good : Tone::bad;
  page.verdict = comparison_verdict(result);
  page.facts = {{fmt::format("{:.2f}", result.misfit()),
                 "chi\u00b2 per degree of freedom (1 is right)", page.tone},
                {result.p_value < 1e-12 ? "next to 0" : probability_text(result.p_value),
                 "chance of errors as large, if the model is right"},
                {std::to_string(result.legs), "legs"},
                {std::to_string(result.landmarks), "landmarks"}};
  if (!result.held_out.legs.empty()) {
    page.facts.insert(page.facts.begin(),
                      {fmt::format("{:.1f} mm", 1000.0 * result.held_out.arrival_rms),
                       "held-out legs end so far off (rms)", page.tone});
  }
  if (!result.consistent) {
    page.answers.push_back(
        {kNext,
         "Give trussmap diagnose the same recordings and model. It names the effect behind the "
         "strongest trend, how large it is, what else it could be, and what to drive to tell."});
  }
  for (const std::string& line : result.advice) {
    page.answers.push_back({"What do these data lack?", capitalised(typeset(line)) + "."});
  }
  for (const std::string& line : result.warnings) {
    page.answers.push_back({"Warnings", capitalised(typeset(line)) + "."});
  }
  page.sections.push_back({"The map as a truss",
                           {ChartRow{truss_chart("map", "Map with the forces in its bars",
                                                 model.map, result.routes, loudest_force(result)),
                                     worst_chart("worst-legs", result.worst, kWorst)}}});
  page.sections.push_back(trend_section("What the errors go with", result, trends));
  page.sections.push_back({"Is the noise right?", {}});
  ChartRow noise{source_chart("noise", {{"", result.sources}})};
  if (!result.held_out.legs.empty()) {
    noise.push_back(held_out_chart("held-out", {{"", result.held_out}}));
  }
  page.sections.back().blocks.emplace_back(std::move(noise));
  add_quantiles(page.sections.back(), {{"", model}});
  page.sections.push_back(
      {"Legs and routes",
       {ChartRow{legs_chart("stretch", result.worst, LegError::stretch),
                 legs_chart("orientation", result.worst, LegError::orientation)}}});
  if (!result.routes.empty()) page.sections.back().blocks.emplace_back(route_table(result));
  if (!result.outliers.empty()) page.sections.back().blocks.emplace_back(outlier_table(result));
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
