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
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

constexpr std::size_t kTrends = 12;
constexpr std::size_t kWorstLegs = 12;

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
plot::Chart strength_chart(const std::vector<EffectEvidence>& effects) {
  plot::Chart chart;
  chart.id = "coefficients";
  chart.title = "How sure are the coefficients?";
  chart.caption =
      "Each coefficient in standard errors, with its 95 % interval. One whose interval holds 0 is "
      "not seen by these recordings.";
  chart.x = {.title = "coefficient over its standard error", .zero = true};
  chart.layers.push_back({plot::LayerKind::upright, "", {{"no effect", {0.0}}}, "faint"});
  plot::ChartLayer layer{
      plot::LayerKind::intervals,
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
      const double numbers[] = {strength, strength - plot::kNormal95, strength + plot::kNormal95,
                                effect.coefficients[k], sd};
      for (std::size_t i = 0; i < 5; ++i) layer.columns[i + 1].numbers.push_back(numbers[i]);
    }
  }
  plot::make_unique(layer.columns[0].texts);
  chart.y.categories = layer.columns[0].texts;
  chart.height = plot::bars_height(chart.y.categories.size());
  if (!chart.y.categories.empty()) chart.layers.push_back(std::move(layer));
  return chart;
}

PageTable trend_table(const Comparison& result) {
  PageTable table;
  table.caption = fmt::format(
      "Trends, strongest first (of {} looked for). Stretch: measured too long; orientation: too "
      "far "
      "to the left; chi\u00b2: squared errors over what noise makes of them",
      result.trends.size());
  table.headings = {"error of", "goes with", "explains chi\u00b2", "size (rms)", "p, adjusted"};
  table.texts = 2;
  for (const Trend& trend : result.trends) {
    if (table.rows.size() == kTrends) break;
    table.rows.push_back({trend.kind, trend_variable(trend), fmt::format("{:.1f}", trend.score),
                          wording::shown(trend.size, trend.unit),
                          probability_text(trend.p_adjusted)});
    table.tones.push_back(trend.p_adjusted < result.level ? Tone::bad : Tone::neutral);
  }
  return table;
}

PageTable model_table(const NamedModel& before, const NamedModel& after) {
  PageTable table;
  table.caption =
      "The two models; chi\u00b2 (squared errors over what noise makes of them) is about "
      "as large as its degrees of freedom where a model is right";
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

/// ", leaves 16 mm".
std::string leaves(const Effect& effect, const LeftBy& left) {
  const auto found = left.find(effect.name);
  return found == left.end() ? "" : ", leaves " + distance_text(found->second);
}

/// Curves of rivals that differ in nothing but their place or threshold are one.
std::vector<plot::NamedCurve> rival_curves(const EffectEvidence& effect, const LeftBy& left) {
  std::vector<plot::NamedCurve> curves;
  for (std::size_t k = 0; k < effect.response.rivals.size(); ++k) {
    const Effect& rival = effect.rivals[k];
    const bool same = k > 0 && rival.channel == effect.rivals[k - 1].channel &&
                      rival.shape == effect.rivals[k - 1].shape;
    if (same) {
      curves.back().name += " or " + name_in_words(rival);
    } else {
      curves.push_back({name_in_words(rival) + leaves(rival, left), effect.response.rivals[k]});
    }
  }
  return curves;
}

plot::Chart effect_chart(const std::string& id, const EffectEvidence& effect, const LeftBy& left) {
  const std::vector<plot::NamedCurve> rivals = rival_curves(effect, left);
  std::string caption =
      "Points: the error that the recordings show where the model lacks this effect, with 95 % "
      "intervals. Line: the effect as fitted. Where they agree, the effect has the right shape.";
  if (!rivals.empty()) {
    caption +=
        " Dashed: what the points would show if it were the other effect instead; the nearer to "
        "the points, the harder to tell.";
  }
  return plot::response_chart(id, name_in_words(effect.estimate.effect), caption, effect.response,
                              "as fitted" + leaves(effect.estimate.effect, left), rivals);
}

}  // namespace

PageSection effect_section(const std::string& title, const std::vector<EffectEvidence>& effects,
                           const LeftBy& left) {
  PageSection section{title, {}};
  ChartRow signatures;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (effects[k].response.bins.empty()) continue;
    signatures.push_back(effect_chart(fmt::format("effect-{}", k + 1), effects[k], left));
  }
  if (!signatures.empty()) section.blocks.emplace_back(std::move(signatures));
  section.details.emplace_back(ChartRow{strength_chart(effects)});
  section.details.emplace_back(effect_table(effects));
  return section;
}

PageSection gain_section(const NamedModel& before, const NamedModel& after, double floor,
                         const std::vector<plot::LadderStep>& ladder) {
  PageSection section{"What it gains", {}};
  const Comparison& one = before.model.comparison;
  const Comparison& other = after.model.comparison;
  if (!other.held_out.legs.empty()) {
    const std::vector<plot::LadderStep> two{
        {before.name, one.held_out.arrival_rms, one.chi2, one.dof},
        {after.name, other.held_out.arrival_rms, other.chi2, other.dof}};
    ChartRow charts{plot::ladder_chart("ladder", ladder.empty() ? two : ladder, floor),
                    plot::held_out_chart(
                        "held-out", {{before.name, one.held_out}, {after.name, other.held_out}})};
    charts[0].height = std::max(charts[0].height, charts[1].height);
    section.blocks.emplace_back(std::move(charts));
  }
  section.details.emplace_back(model_table(before, after));
  return section;
}

PageSection maps_section(const std::string& title, const std::vector<NamedModel>& models,
                         const std::vector<EffectEvidence>& effects) {
  std::vector<Effect> placed;
  placed.reserve(effects.size());
  for (const EffectEvidence& one : effects) placed.push_back(one.estimate.effect);
  std::vector<std::vector<plot::RouteError>> routes;
  routes.reserve(models.size());
  double worst = 0.0;
  for (const NamedModel& one : models) {
    routes.push_back(plot::route_errors(one.model.comparison.worst, one.model.map));
    if (!routes.back().empty()) worst = std::max(worst, routes.back().front().rms);
  }
  ChartRow maps;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const std::string id = models.size() == 1 ? "map" : fmt::format("map-{}", k + 1);
    const std::string name = capitalised(models[k].name);
    // Without landmarks there are no routes: the path alone.
    maps.push_back(routes[k].empty() ? plot::truss_chart(id, name, models[k].model.map, {}, 1.0)
                                     : plot::route_chart(id, name, models[k].model.map, routes[k],
                                                         plot::by_wheels_alone(worst)));
    plot::add_places(maps.back(), placed);
    if (k > 0) maps.back().caption = "The same millimetres have the same colour as in the first.";
  }
  return {title, {std::move(maps)}};
}

PageSection noise_section(const std::vector<NamedModel>& models) {
  std::vector<plot::NamedSources> sources;
  sources.reserve(models.size());
  for (const NamedModel& one : models) {
    sources.emplace_back(models.size() > 1 ? one.name : "", one.model.comparison.sources);
  }
  PageSection section{"Is the noise right?", {ChartRow{plot::source_chart("noise", sources)}}};
  ChartRow charts;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const bool alone = models.size() == 1;
    plot::Chart chart =
        plot::quantile_chart(alone ? "quantiles" : fmt::format("quantiles-{}", k + 1),
                             std::string("Do the errors scatter as stated?") +
                                 (alone ? "" : " \u2013 " + models[k].name),
                             models[k].model.comparison.residuals);
    if (chart.layers.size() > 1) charts.push_back(std::move(chart));
    plot::Chart counted = plot::histogram_chart(
        alone ? "histogram" : fmt::format("histogram-{}", k + 1),
        std::string("How large are the errors?") + (alone ? "" : " \u2013 " + models[k].name),
        models[k].model.comparison.residuals);
    if (!counted.layers.empty()) charts.push_back(std::move(counted));
  }
  if (!charts.empty()) section.details.emplace_back(std::move(charts));
  return section;
}

PageSection noise_section(const NamedModel& model, const FittedNoise& found) {
  std::vector<SourceCalibration> sources;
  for (const NoiseSource& one : found.sources) {
    if (!(one.stated > 0.0)) continue;
    sources.push_back({one.name, one.sd / one.stated, one.sd_error / one.stated, 0.0});
  }
  PageSection section = noise_section({model});
  plot::Chart chart = plot::source_chart("noise", {{"", sources}});
  chart.title = "Noise as found, over what the model states";
  chart.caption = "1 is as stated. By the noise found the errors scatter as they should.";
  chart.x.title = "found over stated";
  if (!sources.empty()) section.blocks = {ChartRow{std::move(chart)}};
  return section;
}

void close_tables(PageContent& page) {
  for (PageSection& section : page.sections) {
    const auto shown = [](const PageBlock& block) {
      return std::holds_alternative<ChartRow>(block);
    };
    const bool pictures = std::any_of(section.blocks.begin(), section.blocks.end(), shown);
    std::vector<PageBlock> open;
    std::vector<PageBlock> closed;
    for (PageBlock& block : section.blocks) {
      const bool table = std::holds_alternative<PageTable>(block);
      (table || (!pictures && !closed.empty()) ? closed : open).push_back(std::move(block));
    }
    section.blocks = std::move(open);
    section.details.insert(section.details.begin(), std::make_move_iterator(closed.begin()),
                           std::make_move_iterator(closed.end()));
  }
}

PageSection legs_section(const std::string& title, const Comparison& comparison) {
  return {title,
          {},
          {ChartRow{plot::legs_chart("stretch", comparison.worst, plot::LegError::stretch),
                    plot::legs_chart("orientation", comparison.worst, plot::LegError::orientation)},
           ChartRow{plot::worst_chart("worst-legs", comparison.worst, kWorstLegs)}}};
}

PageSection trend_section(const std::string& title, const Comparison& result,
                          const std::vector<TrendEvidence>& trends) {
  PageSection section{title, {}};
  ChartRow charts;
  std::vector<std::string> without;
  for (const TrendEvidence& one : trends) {
    const Trend& trend = one.trend;
    const std::string variable = wording::variable_in_words(one.response.variable);
    if (!(trend.p_adjusted < result.level)) {
      without.push_back(variable);
      continue;
    }
    charts.push_back(plot::response_chart(
        fmt::format("trend-{}", charts.size() + 1), name_in_words(one),
        fmt::format("A trend: it explains {:.2g} % of chi\u00b2 (squared errors over what noise "
                    "makes of them), p {}. Points are what the recordings show, with 95 % "
                    "intervals.",
                    100.0 * trend.score / std::max(result.chi2, 1e-300),
                    probability_text(trend.p_adjusted)),
        one.response, "trend"));
  }
  const bool any = !charts.empty();
  if (any) section.blocks.emplace_back(std::move(charts));
  if (!without.empty()) {
    section.blocks.emplace_back(fmt::format("{} trend with {} (p of {:g} and more).",
                                            any ? "No" : "The errors go with nothing: no",
                                            listed(without, "or"), result.level));
  }
  section.details.emplace_back(trend_table(result));
  return section;
}

}  // namespace trussmap::report
