// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/report/fit_page.hpp"

#include "trussmap/criticism/effect_words.hpp"
#include "trussmap/report/fit_charts.hpp"
#include "trussmap/report/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "layers.hpp"

namespace trussmap {
namespace {

constexpr const char* kBefore = "without effects";
constexpr const char* kAfter = "with them";

std::string millimetres(const Comparison& one) {
  return fmt::format("{:.0f} mm", 1000.0 * one.held_out.arrival_rms);
}

/// The report's words in the signs that a page has.
std::string typeset(std::string text) {
  for (std::size_t at = text.find("+-"); at != std::string::npos; at = text.find("+-", at)) {
    text.replace(at, 2, "\u00b1");
  }
  return text;
}

std::string verdict(const Comparison& before, const Comparison& after,
                    const std::vector<FittedEffect>& effects) {
  std::string text;
  if (effects.size() == 1) {
    const EffectEstimate& only = effects.front().estimate;
    text = only.effect.name + ": " + typeset(in_words(only.effect, only.sd)) + ".";
  } else {
    text = fmt::format("{} effects fitted.", effects.size());
  }
  if (!before.held_out.legs.empty() && !after.held_out.legs.empty()) {
    text += fmt::format(" Legs that no fit has seen end {} off without, {} with.",
                        millimetres(before), millimetres(after));
  }
  return text + (after.consistent ? " The model now explains the measurements."
                                  : " Something is still unexplained.");
}

PageTable effect_table(const std::vector<FittedEffect>& effects) {
  PageTable table;
  table.caption = "Coefficients with standard errors";
  table.headings = {"effect", "channel", "shape", "coefficient", "standard error"};
  table.texts = 3;
  for (const FittedEffect& one : effects) {
    const Effect& effect = one.estimate.effect;
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      const QuantityText text = quantity_text(effect.coefficients[k], one.estimate.sd[k]);
      table.rows.push_back({k == 0 ? effect.name : "", effect.channel,
                            effect.shape[k % effect.shape.size()], text.value, text.error});
    }
  }
  return table;
}

/// Coefficients in standard errors from zero: the only scale that all share.
Chart strength_chart(const std::vector<FittedEffect>& effects) {
  Chart chart;
  chart.id = "coefficients";
  chart.title = "How sure are the coefficients?";
  chart.caption =
      "Each coefficient in standard errors, with its 95 % interval. One whose interval holds 0 is "
      "not seen by these recordings.";
  chart.x = {.title = "coefficient over its standard error", .zero = true};
  chart.layers.push_back({LayerKind::upright, "", {{"no effect", {0.0}}}, "faint"});
  ChartLayer layer{LayerKind::intervals,
                   "",
                   {{"coefficient"}, {"standard errors"}, {"95 % from"}, {"to"}, {"value"}, {"sd"}},
                   "1"};
  for (const FittedEffect& one : effects) {
    for (std::size_t k = 0; k < one.estimate.effect.coefficients.size(); ++k) {
      const double sd = one.estimate.sd[k];
      if (!(sd > 0.0) || !std::isfinite(sd)) continue;
      const Effect& effect = one.estimate.effect;
      const double strength = effect.coefficients[k] / sd;
      layer.columns[0].texts.push_back(effect.name + " \u00d7 " +
                                       effect.shape[k % effect.shape.size()]);
      const double numbers[] = {strength, strength - kNormal95, strength + kNormal95,
                                effect.coefficients[k], sd};
      for (std::size_t i = 0; i < 5; ++i) layer.columns[i + 1].numbers.push_back(numbers[i]);
    }
  }
  make_unique(layer.columns[0].texts);
  chart.y.categories = layer.columns[0].texts;
  chart.height = bars_height(chart.y.categories.size());
  if (!chart.y.categories.empty()) chart.layers.push_back(std::move(layer));
  return chart;
}

PageSection effect_section(const std::vector<FittedEffect>& effects) {
  PageSection section{"The effects", {}};
  ChartRow signatures;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const FittedEffect& one = effects[k];
    if (one.response.bins.empty()) continue;
    Response drawn = one.response;
    if (drawn.curve.empty()) {
      drawn.curve = effect_curve(one.estimate.effect, drawn.variable, drawn.bins.front().at,
                                 drawn.bins.back().at);
    }
    signatures.push_back(response_chart(
        fmt::format("effect-{}", k + 1), one.estimate.effect.name,
        "Points: the error that the recordings show where the model lacks all effects, with 95 % "
        "intervals. Line: the effect as fitted. Where they agree, the effect has the right shape.",
        drawn, "as fitted"));
  }
  if (!signatures.empty()) section.blocks.emplace_back(std::move(signatures));
  section.blocks.emplace_back(ChartRow{strength_chart(effects)});
  section.blocks.emplace_back(effect_table(effects));
  return section;
}

PageTable model_table(const Comparison& before, const Comparison& after) {
  PageTable table;
  table.caption = "The two models";
  table.headings = {"", "chi\u00b2", "degrees of freedom", "p", "held-out legs end off [mm]"};
  const auto row = [&table](const char* name, const Comparison& one) {
    table.rows.push_back({name, fmt::format("{:.1f}", one.chi2), std::to_string(one.dof),
                          probability_text(one.p_value),
                          one.held_out.legs.empty()
                              ? "-"
                              : fmt::format("{:.1f}", 1000.0 * one.held_out.arrival_rms)});
    table.tones.push_back(one.consistent ? Tone::good : Tone::bad);
  };
  row(kBefore, before);
  row(kAfter, after);
  return table;
}

}  // namespace

Page fit_page(const FittedModel& without, const FittedModel& with,
              const std::vector<FittedEffect>& effects, const std::string& subject) {
  const Comparison& before = without.comparison;
  const Comparison& after = with.comparison;
  Page page;
  page.command = "fit";
  page.subject = subject;
  page.tone = after.consistent ? Tone::good : Tone::bad;
  page.verdict = verdict(before, after, effects);
  page.facts = {
      {fmt::format("{:.2f}", before.misfit()), "chi\u00b2 per degree of freedom without effects"},
      {fmt::format("{:.2f}", after.misfit()), "the same with them (1 is right)", page.tone}};
  if (!after.held_out.legs.empty()) {
    page.facts.push_back({millimetres(before), "held-out legs end so far off without effects"});
    page.facts.push_back({millimetres(after), "the same with them", page.tone});
  }
  for (const FittedEffect& one : effects) {
    if (effects.size() > 1) {
      page.notes.push_back(one.estimate.effect.name + ": " +
                           typeset(in_words(one.estimate.effect, one.estimate.sd)));
    }
    for (const std::string& why : one.estimate.not_fitted) page.notes.push_back(why);
  }
  page.notes.insert(page.notes.end(), after.warnings.begin(), after.warnings.end());
  page.sections.push_back(effect_section(effects));
  PageSection gain{"What it gains", {}};
  if (!after.held_out.legs.empty()) {
    gain.blocks.emplace_back(ChartRow{
        ladder_chart("ladder", {{kBefore, before.held_out.arrival_rms, before.chi2, before.dof},
                                {kAfter, after.held_out.arrival_rms, after.chi2, after.dof}}),
        held_out_chart("held-out", {{kBefore, before.held_out}, {kAfter, after.held_out}})});
  }
  gain.blocks.emplace_back(
      ChartRow{source_chart("noise", {{kBefore, before.sources}, {kAfter, after.sources}})});
  gain.blocks.emplace_back(model_table(before, after));
  page.sections.push_back(std::move(gain));
  page.sections.push_back(
      {"The map, before and after",
       {ChartRow{truss_chart("map-before", "Without effects", without.map, before.routes,
                             before.misfit()),
                 truss_chart("map-after", "With them", with.map, after.routes, after.misfit())}}});
  page.sections.push_back({"Legs, with the effects",
                           {ChartRow{legs_chart("stretch", after.worst, LegError::stretch),
                                     legs_chart("orientation", after.worst, LegError::orientation)},
                            ChartRow{worst_chart("worst-legs", after.worst, 12)}}});
  return page;
}

}  // namespace trussmap
