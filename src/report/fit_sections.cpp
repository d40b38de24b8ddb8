// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/fit_sections.hpp"

#include "plot/fit_charts.hpp"
#include "plot/layers.hpp"
#include "report/page_words.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kTrends = 12;

PageTable effect_table(const std::vector<EffectEvidence>& effects) {
  PageTable table;
  table.caption = "Coefficients with standard errors";
  table.headings = {"effect", "channel", "shape", "coefficient", "standard error"};
  table.texts = 3;
  for (const EffectEvidence& one : effects) {
    const Effect& effect = one.estimate.effect;
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      const QuantityText text = quantity_text(effect.coefficients[k], one.estimate.sd[k]);
      table.rows.push_back({k == 0 ? name_in_words(effect) : "",
                            std::string(name_of(effect.channel)),
                            effect.shape[k % effect.shape.size()].text(), text.value, text.error});
    }
  }
  return table;
}

/// Coefficients in standard errors from zero: the only scale that all share.
Chart strength_chart(const std::vector<EffectEvidence>& effects) {
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
  for (const EffectEvidence& one : effects) {
    for (std::size_t k = 0; k < one.estimate.effect.coefficients.size(); ++k) {
      const double sd = one.estimate.sd[k];
      if (!(sd > 0.0) || !std::isfinite(sd)) continue;
      const Effect& effect = one.estimate.effect;
      const double strength = effect.coefficients[k] / sd;
      layer.columns[0].texts.push_back(name_in_words(effect) + " \u00d7 " +
                                       effect.shape[k % effect.shape.size()].text());
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

PageTable trend_table(const Comparison& result) {
  PageTable table;
  table.caption = fmt::format("Trends, strongest first (of {} looked for)", result.trends.size());
  table.headings = {"error of", "goes with", "explains chi\u00b2", "size (rms)", "p, adjusted"};
  table.texts = 2;
  for (const Trend& trend : result.trends) {
    if (table.rows.size() == kTrends) break;
    table.rows.push_back({trend.kind, trend_variable(trend), fmt::format("{:.1f}", trend.score),
                          shown(trend.size, trend.unit), probability_text(trend.p_adjusted)});
    table.tones.push_back(trend.p_adjusted < kSignificance ? Tone::bad : Tone::neutral);
  }
  return table;
}

PageTable model_table(const NamedModel& before, const NamedModel& after) {
  PageTable table;
  table.caption = "The two models";
  table.headings = {"", "chi\u00b2", "degrees of freedom", "p", "held-out legs end off [mm]"};
  for (const NamedModel* named : {&before, &after}) {
    const Comparison& one = named->model.comparison;
    table.rows.push_back({named->name, fmt::format("{:.1f}", one.chi2), std::to_string(one.dof),
                          probability_text(one.p_value),
                          one.held_out.legs.empty()
                              ? "-"
                              : fmt::format("{:.1f}", 1000.0 * one.held_out.arrival_rms)});
    table.tones.push_back(one.consistent() ? Tone::good : Tone::bad);
  }
  return table;
}

/// Curves of rivals that differ in nothing but their place or threshold are one.
std::vector<NamedCurve> rival_curves(const EffectEvidence& effect) {
  std::vector<NamedCurve> curves;
  for (std::size_t k = 0; k < effect.response.rivals.size(); ++k) {
    const Effect& rival = effect.rivals[k];
    const bool same = k > 0 && rival.channel == effect.rivals[k - 1].channel &&
                      rival.shape == effect.rivals[k - 1].shape;
    if (same) {
      curves.back().name += " or " + name_in_words(rival);
    } else {
      curves.push_back({name_in_words(rival), effect.response.rivals[k]});
    }
  }
  return curves;
}

Chart effect_chart(const std::string& id, const EffectEvidence& effect) {
  const std::vector<NamedCurve> rivals = rival_curves(effect);
  std::string caption =
      "Points: the error that the recordings show where the model lacks this effect, with 95 % "
      "intervals. Line: the effect as fitted. Where they agree, the effect has the right shape.";
  if (!rivals.empty()) {
    caption +=
        " Dashed: what the points would show if it were the other effect instead; the nearer to "
        "the points, the harder to tell.";
  }
  return response_chart(id, name_in_words(effect.estimate.effect), caption, effect.response,
                        "as fitted", rivals);
}

}  // namespace

PageSection effect_section(const std::string& title, const std::vector<EffectEvidence>& effects) {
  PageSection section{title, {}};
  ChartRow signatures;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (effects[k].response.bins.empty()) continue;
    signatures.push_back(effect_chart(fmt::format("effect-{}", k + 1), effects[k]));
  }
  if (!signatures.empty()) section.blocks.emplace_back(std::move(signatures));
  section.blocks.emplace_back(ChartRow{strength_chart(effects)});
  section.blocks.emplace_back(effect_table(effects));
  return section;
}

PageSection gain_section(const NamedModel& before, const NamedModel& after,
                         const std::vector<LadderStep>& ladder) {
  PageSection section{"What it gains", {}};
  const Comparison& one = before.model.comparison;
  const Comparison& other = after.model.comparison;
  if (!other.held_out.legs.empty()) {
    const std::vector<LadderStep> two{
        {before.name, one.held_out.arrival_rms, one.chi2, one.dof},
        {after.name, other.held_out.arrival_rms, other.chi2, other.dof}};
    ChartRow charts{
        ladder_chart("ladder", ladder.empty() ? two : ladder),
        held_out_chart("held-out", {{before.name, one.held_out}, {after.name, other.held_out}})};
    charts[0].height = std::max(charts[0].height, charts[1].height);
    section.blocks.emplace_back(std::move(charts));
  }
  section.blocks.emplace_back(
      ChartRow{source_chart("noise", {{before.name, one.sources}, {after.name, other.sources}})});
  add_quantiles(section, {before, after});
  section.blocks.emplace_back(model_table(before, after));
  return section;
}

PageSection maps_section(const std::string& title, const std::vector<NamedModel>& models) {
  double loudest = 0.0;
  for (const NamedModel& one : models) {
    loudest = std::max(loudest, loudest_force(one.model.comparison));
  }
  ChartRow maps;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const NamedModel& one = models[k];
    std::string name = one.name;
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    maps.push_back(truss_chart(fmt::format("map-{}", k + 1), name, one.model.map,
                               one.model.comparison.routes, loudest));
    if (k == 0) continue;
    maps.back().caption =
        "Colours as in the first map: the greyer, the better the model agrees with what was "
        "measured.";
  }
  return {title, {std::move(maps)}};
}

void add_quantiles(PageSection& section, const std::vector<NamedModel>& models) {
  ChartRow charts;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const bool alone = models.size() == 1;
    Chart chart = quantile_chart(alone ? "quantiles" : fmt::format("quantiles-{}", k + 1),
                                 std::string("Do the errors scatter as stated?") +
                                     (alone ? "" : " \u2013 " + models[k].name),
                                 models[k].model.comparison.residuals);
    if (chart.layers.size() > 1) charts.push_back(std::move(chart));
  }
  if (!charts.empty()) section.blocks.emplace_back(std::move(charts));
}

void move_tables_last(PageContent& page) {
  PageSection last{"Tables", {}};
  for (PageSection& section : page.sections) {
    const auto is = [](const PageBlock& block) { return std::holds_alternative<ChartRow>(block); };
    if (std::none_of(section.blocks.begin(), section.blocks.end(), is)) continue;
    for (PageBlock& block : section.blocks) {
      if (std::holds_alternative<PageTable>(block)) last.blocks.push_back(std::move(block));
    }
    std::erase_if(section.blocks,
                  [](const PageBlock& block) { return std::holds_alternative<PageTable>(block); });
  }
  if (!last.blocks.empty()) page.sections.push_back(std::move(last));
}

PageSection fit_section(const NamedModel& model) {
  const Comparison& one = model.model.comparison;
  ChartRow noise{source_chart("noise", {{"", one.sources}})};
  if (!one.held_out.legs.empty()) noise.push_back(held_out_chart("held-out", {{"", one.held_out}}));
  PageSection section{"The map and the noise",
                      {ChartRow{truss_chart("map", "Map with the forces in its bars",
                                            model.model.map, one.routes, loudest_force(one))},
                       std::move(noise)}};
  add_quantiles(section, {model});
  return section;
}

PageSection legs_section(const std::string& title, const Comparison& comparison) {
  return {title,
          {ChartRow{legs_chart("stretch", comparison.worst, LegError::stretch),
                    legs_chart("orientation", comparison.worst, LegError::orientation)},
           ChartRow{worst_chart("worst-legs", comparison.worst, 12)}}};
}

PageSection trend_section(const std::string& title, const Comparison& result,
                          const std::vector<TrendEvidence>& trends) {
  PageSection section{title, {}};
  section.blocks.emplace_back(
      "For every variable, the error that goes with it most. Points are what the recordings show, "
      "with 95 % intervals; the line is the trend that a score test finds. Points on zero: nothing "
      "there.");
  ChartRow charts;
  for (std::size_t k = 0; k < trends.size(); ++k) {
    const Trend& trend = trends[k].trend;
    charts.push_back(response_chart(
        fmt::format("trend-{}", k + 1),
        trend.kind + " against " + variable_in_words(trends[k].response.variable),
        trend.p_adjusted < kSignificance
            ? fmt::format("A trend: it explains {:.2g} % of chi\u00b2, p {}.",
                          100.0 * trend.score / std::max(result.chi2, 1e-300),
                          probability_text(trend.p_adjusted))
            : fmt::format("No trend to speak of: p {}.", probability_text(trend.p_adjusted)),
        trends[k].response, "trend"));
  }
  if (!charts.empty()) section.blocks.emplace_back(std::move(charts));
  section.blocks.emplace_back(trend_table(result));
  return section;
}

}  // namespace trussmap
