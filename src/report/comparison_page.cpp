// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "plot/fit_charts.hpp"
#include "report/fit_sections.hpp"
#include "report/page_words.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kWorst = 12;
constexpr std::size_t kRoutes = 30;

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

/// The trend to name, where one is clear.
const Trend* telling_trend(const Comparison& result) {
  const bool clear = !result.trends.empty() && result.trends.front().p_adjusted < kSignificance;
  return clear ? &result.trends.front() : nullptr;
}

std::string page_verdict(const Comparison& result) {
  const bool legs = !result.held_out.legs.empty();
  const std::string held =
      legs ? fmt::format("{:.0f} mm", 1000.0 * result.held_out.arrival_rms) : "";
  if (result.consistent() && !result.tested()) {
    return "Nothing contradicts the model, " + objection_in_words(result) + ".";
  }
  if (result.consistent()) {
    return "The model explains these measurements" +
           (legs ? ": legs that it has not seen end " + held + " off, as its noise lets one expect."
                 : std::string(" to within its noise."));
  }
  std::string text = "The model does not explain these measurements: " + objection_in_words(result);
  if (legs) text += ", and legs that it has not seen end " + held + " off";
  text += ".";
  if (const Trend* first = telling_trend(result)) {
    text += fmt::format(
        " Most telling: the {} error{} ({}).", first->kind,
        first->against == "all" ? ", everywhere alike" : " goes with " + trend_variable(*first),
        shown(first->size, first->unit));
  }
  return text;
}

std::vector<PageFact> facts_on(const Comparison& result, Tone tone) {
  std::vector<PageFact> facts;
  if (!result.held_out.legs.empty()) {
    facts.push_back({fmt::format("{:.1f} mm", 1000.0 * result.held_out.arrival_rms),
                     "held-out legs end so far off (rms)", tone});
  }
  facts.push_back({fmt::format("{:.2f}", result.misfit()),
                   "chi\u00b2 per degree of freedom (1 is right)", tone});
  facts.push_back({chance_text(result.p_value),
                   "p-value of chi\u00b2: the chance of errors as large, if the model is right"});
  facts.push_back({std::to_string(result.legs), "legs"});
  facts.push_back({std::to_string(result.landmarks), "landmarks"});
  return facts;
}

std::vector<PageAnswer> answers_on(const Comparison& result) {
  std::vector<PageAnswer> answers;
  if (!result.consistent()) {
    answers.push_back(
        {kNext,
         "Give trussmap diagnose the same recordings and model. It names the effect behind the "
         "strongest trend, how large it is, what else it could be, and what to drive to tell."});
  }
  for (const std::string& line : in_words(result.lacks)) {
    answers.push_back({"What do these data lack?", capitalised(typeset(line)) + "."});
  }
  for (const std::string& line : result.warnings) {
    answers.push_back({"Warnings", capitalised(typeset(line)) + "."});
  }
  return answers;
}

PageSection map_section(const ModelEvidence& model) {
  const Comparison& result = model.comparison;
  return {"The map as a truss",
          {ChartRow{truss_chart("map", "Map with the forces in its bars", model.map, result.routes,
                                loudest_force(result)),
                    worst_chart("worst-legs", result.worst, kWorst)}}};
}

PageSection noise_section(const ModelEvidence& model) {
  const Comparison& result = model.comparison;
  PageSection section{"Is the noise right?", {}};
  ChartRow noise{source_chart("noise", {{"", result.sources}})};
  if (!result.held_out.legs.empty()) {
    noise.push_back(held_out_chart("held-out", {{"", result.held_out}}));
  }
  section.blocks.emplace_back(std::move(noise));
  add_quantiles(section, {{"", model}});
  return section;
}

PageSection routes_section(const Comparison& result) {
  PageSection section{"Legs and routes",
                      {ChartRow{legs_chart("stretch", result.worst, LegError::stretch),
                                legs_chart("orientation", result.worst, LegError::orientation)}}};
  if (!result.routes.empty()) section.blocks.emplace_back(route_table(result));
  if (!result.outliers.empty()) section.blocks.emplace_back(outlier_table(result));
  return section;
}

}  // namespace

Page comparison_page(const ComparisonEvidence& evidence, const std::string& subject) {
  const Comparison& result = evidence.model.comparison;
  PageContent page;
  page.command = "compare";
  page.subject = subject;
  page.tone = !result.consistent() ? Tone::bad : result.tested() ? Tone::good : Tone::neutral;
  page.verdict = page_verdict(result);
  page.facts = facts_on(result, page.tone);
  page.answers = answers_on(result);
  page.sections = {map_section(evidence.model),
                   trend_section("What the errors go with", result, evidence.trends),
                   noise_section(evidence.model), routes_section(result)};
  move_tables_last(page);
  return page;
}

}  // namespace trussmap
