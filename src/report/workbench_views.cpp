// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/workbench_views.hpp"

#include "drive/elapsed_time.hpp"
#include "plot/fit_charts.hpp"
#include "plot/time_strips.hpp"
#include "report/page_words.hpp"
#include "report/view_json.hpp"
#include "statistics/median.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

using nlohmann::ordered_json;

constexpr double kMapHeight = 320.0;  // so that the plot below is on the same screen

using IsShown = std::function<bool(std::size_t leg)>;

/// Held-out legs: how far off in all, the middle one, the worst.
ordered_json figure_json(const HeldOut& held_out, const IsShown& is_shown) {
  std::vector<double> off;
  double squares = 0.0, expected = 0.0;
  const LegPrediction* worst = nullptr;
  for (const LegPrediction& leg : held_out.legs) {
    if (!is_shown(leg.leg)) continue;
    off.push_back(leg.arrival_error.norm());
    squares += leg.arrival_error.squaredNorm();
    expected += leg.expected_error * leg.expected_error;
    if (worst == nullptr || off.back() > worst->arrival_error.norm()) worst = &leg;
  }
  if (worst == nullptr) return nullptr;
  const auto count = static_cast<double>(off.size());
  const double rms = std::sqrt(squares / count);
  const double floor = std::sqrt(expected / count);
  ordered_json result = {{"now", distance_text(rms)},
                         {"now_mm", 1e3 * rms},
                         {"floor", distance_text(floor)},
                         {"floor_mm", 1e3 * floor},
                         {"legs", off.size()},
                         {"median", distance_text(statistics::median(std::move(off)))},
                         {"worst", distance_text(worst->arrival_error.norm())}};
  if (!worst->from.empty()) {
    result["worst_leg"] =
        fmt::format("{} \u2192 {} at t = {:.0f} s", worst->from, worst->to, worst->t);
  }
  return result;
}

/// Straight lines from where legs begin to where they end.
plot::ChartLayer leg_layer(const std::vector<TriedLeg>& legs, const std::string& name,
                           const std::string& colour,
                           const std::function<bool(const TriedLeg&)>& which) {
  plot::ChartLayer layer{plot::LayerKind::segments,
                         name,
                         {{""}, {""}, {""}, {""}, {"from"}, {"to"}, {"from [s]"}, {"to [s]"}},
                         colour};
  for (const TriedLeg& leg : legs) {
    if (!which(leg)) continue;
    const double numbers[] = {leg.begin.x(), leg.begin.y(), leg.end.x(), leg.end.y()};
    for (std::size_t c = 0; c < 4; ++c) layer.columns[c].numbers.push_back(numbers[c]);
    layer.columns[4].texts.push_back(leg.from);
    layer.columns[5].texts.push_back(leg.to);
    layer.columns[6].numbers.push_back(leg.time.from);
    layer.columns[7].numbers.push_back(leg.time.to);
  }
  layer.size = 2.0;
  return layer;
}

/// Routes by what is left: by the legs held out, on one scale for all steps; where none is, by the
/// wheels alone, of which `worst`, m, is the worst of all.
plot::Chart routes_of(const TriedModel& now, const IsShown& is_shown, double first_rms,
                      double worst) {
  const auto shown = [&is_shown](const auto& legs) {
    auto some = legs;
    std::erase_if(some, [&is_shown](const auto& leg) { return !is_shown(leg.leg); });
    return some;
  };
  const std::vector<LegMisfit>& misfits = now.comparison().worst;
  const bool held_out = first_rms > 0.0 && !now.diagnosis().held_out.legs.empty();
  const std::vector<plot::RouteError> routes =
      held_out
          ? plot::held_out_errors(shown(now.diagnosis().held_out.legs), shown(misfits), now.map())
          : plot::route_errors(shown(misfits), now.map());
  return plot::route_chart(
      "map", "The map, routes by what is left", now.map(), routes,
      held_out ? plot::by_held_out_legs(first_rms) : plot::by_wheels_alone(worst));
}

plot::Chart map_of(const TriedModel& now, const IsShown& is_shown, bool all, double first_rms) {
  plot::Chart map;
  const std::vector<plot::RouteError> routes =
      plot::route_errors(now.comparison().worst, now.map());
  if (routes.empty()) {
    map = plot::truss_chart("map", "The map", now.map(), {}, 1.0);
    if (!all) {
      map.layers.push_back(leg_layer(now.legs(), "chosen", "2", [&is_shown](const TriedLeg& leg) {
        return is_shown(leg.number);
      }));
    }
  } else {
    map = routes_of(now, is_shown, first_rms, routes.front().rms);
  }
  std::vector<Effect> acting;
  for (const EffectEstimate& one : now.fit().effects) acting.push_back(one.effect);
  for (const Finding* one : found_by(now.diagnosis())) acting.push_back(one->effect);
  plot::add_places(map, acting);
  const auto is_excluded = [](const TriedLeg& leg) { return leg.excluded; };
  if (std::ranges::any_of(now.legs(), is_excluded)) {
    map.layers.push_back(leg_layer(now.legs(), "excluded", "muted", is_excluded));
    map.layers.back().dashed = true;
  }
  map.height = kMapHeight;
  return map;
}

ordered_json strips_json(const TriedModel& now, const IsShown& is_shown, bool all) {
  const std::vector<double> shifts = drive::elapsed_shifts(now.recordings());
  plot::MarkedTimes marked;
  for (const TriedLeg& leg : now.legs()) {
    const double shift = shifts[leg.recording];
    const TimeSpan span{leg.time.from + shift, leg.time.to + shift};
    if (leg.excluded) marked.excluded.push_back(span);
    if (!all && is_shown(leg.number)) marked.chosen.push_back(span);
  }
  ordered_json strips = ordered_json::array();
  for (const plot::Chart& strip : plot::time_strips(now.recordings(), marked)) {
    strips.push_back(chart_view(strip));
  }
  return strips;
}

/// How many there are, and what can be done with them.
ordered_json legs_json(const std::vector<TriedLeg>& legs, const IsShown& is_shown, bool all) {
  std::size_t shown = 0, held_out = 0, excluded = 0, free = 0;
  for (const TriedLeg& leg : legs) {
    if (!is_shown(leg.number)) continue;
    ++shown;
    held_out += leg.held_out ? 1 : 0;
    excluded += leg.excluded ? 1 : 0;
    free += !leg.held_out && !leg.excluded ? 1 : 0;
  }
  std::string words;
  if (all) {
    words = counted_legs(shown) + ".";
  } else {
    words = fmt::format("{} of {} chosen.", shown, counted_legs(legs.size()));
  }
  if (held_out > 0) {
    words += fmt::format(" {} held out: the model is judged by {}, and {} cannot be excluded.",
                         held_out == 1 ? "One is" : fmt::format("{} are", held_out),
                         held_out == 1 ? "it" : "them", held_out == 1 ? "it" : "they");
  }
  if (excluded > 0)
    words +=
        fmt::format(" {} excluded.", excluded == 1 ? "One is" : fmt::format("{} are", excluded));
  return {{"shown", shown},       {"all", legs.size()}, {"held_out", held_out},
          {"excluded", excluded}, {"free", free},       {"words", std::move(words)}};
}

}  // namespace

}  // namespace trussmap

namespace trussmap::report {

ordered_json views_json(const TriedModel& now,
                        const std::optional<std::vector<std::size_t>>& chosen, double first_rms) {
  const IsShown is_shown = [&chosen](std::size_t leg) {
    return !chosen || std::ranges::binary_search(*chosen, leg);
  };
  const bool all = !chosen.has_value();
  return {{"legs", legs_json(now.legs(), is_shown, all)},
          {"figure", figure_json(now.diagnosis().held_out, is_shown)},
          {"map", chart_view(map_of(now, is_shown, all, first_rms))},
          {"strips", strips_json(now, is_shown, all)}};
}

}  // namespace trussmap::report

namespace trussmap {

std::string selection_json(const TriedModel& now, const WorkbenchLog& log,
                           const std::vector<std::size_t>& legs) {
  return safe_text(views_json(now, legs, log.steps.front().arrival_rms));
}

}  // namespace trussmap
