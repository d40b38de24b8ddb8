// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"

#include "geometry/units.hpp"
#include "plot/layers.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr std::size_t kMostLegs = 2000;  // of a chart

/// All estimates and the curve, and intervals as far as they are not much longer.
Range shown_range(const Response& response, double factor) {
  Range near{0.0, 0.0};
  const auto take = [&near](double value) {
    near.low = std::min(near.low, value);
    near.high = std::max(near.high, value);
  };
  for (const ResponseBin& bin : response.bins) take(factor * bin.estimate);
  for (const Vector2& point : response.curve) take(factor * point.y());
  const double reach = std::max(near.high - near.low, 1e-9);
  Range range = near;
  for (const ResponseBin& bin : response.bins) {
    const double half = factor * kNormal95 * bin.sd;
    range.low = std::min(range.low, factor * bin.estimate - half);
    range.high = std::max(range.high, factor * bin.estimate + half);
  }
  const double margin = 0.05 * reach;
  return {std::max(range.low, near.low - reach) - margin,
          std::min(range.high, near.high + reach) + margin};
}

ChartLayer curve_layer(const NamedCurve& curve, const std::string& axis, double across, double up,
                       const std::string& colour) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Vector2& point : curve.points) {
    x.push_back(across * point.x());
    y.push_back(up * point.y());
  }
  ChartLayer layer{LayerKind::line, curve.name, {{axis, x}, {"error", y}}, colour};
  layer.size = 2.5;
  return layer;
}

}  // namespace

Chart response_chart(const std::string& id, const std::string& title, const std::string& caption,
                     const Response& response, const std::string& curve_name,
                     const std::vector<NamedCurve>& rivals) {
  const ResponseAxes axes = axes_of(response);
  const double across = axes.variable_factor;
  const wording::ShownUnit up = wording::shown_unit(response.unit);
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = caption;
  chart.x.title = axes.variable;
  chart.y.title = axes.error;
  chart.y.range = shown_range(response, up.factor);
  chart.height = 260.0;
  chart.layers.push_back({LayerKind::level, "", {{"no error", {0.0}}}, "faint"});
  ChartColumn at{chart.x.title};
  ChartColumn value{"error [" + up.name + "]"};
  ChartColumn low{"95 % from"};
  ChartColumn high{"to"};
  for (const ResponseBin& bin : response.bins) {
    at.numbers.push_back(across * bin.at);
    value.numbers.push_back(up.factor * bin.estimate);
    low.numbers.push_back(up.factor * (bin.estimate - kNormal95 * bin.sd));
    high.numbers.push_back(up.factor * (bin.estimate + kNormal95 * bin.sd));
  }
  if (!response.curve.empty()) {
    chart.layers.push_back(
        curve_layer({curve_name, response.curve}, chart.x.title, across, up.factor, "2"));
  }
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    const std::string colour = std::to_string(3 + k % 6);
    chart.layers.push_back(curve_layer(rivals[k], chart.x.title, across, up.factor, colour));
    chart.layers.back().dashed = true;
  }
  if (!at.numbers.empty()) {
    chart.layers.push_back(
        {LayerKind::intervals, "seen in the recordings", {at, value, low, high}, "1"});
  }
  return chart;
}

Chart source_chart(const std::string& id, const std::vector<NamedSources>& models) {
  Chart chart;
  chart.id = id;
  chart.title = "Is the noise as large as the model states?";
  chart.caption =
      "Errors of each sensor over what the model's noise makes of them, with 95 % intervals: 1 is "
      "as stated; more means noise that is stated too small, or an effect that is missing.";
  chart.x = {.title = "true over stated noise", .log = true};
  chart.layers.push_back({LayerKind::upright, "as stated", {{"as stated", {1.0}}}, "faint"});
  for (std::size_t k = 0; k < models.size(); ++k) {
    ChartColumn source{"noise of"};
    ChartColumn factor{"true over stated"};
    ChartColumn low{"95 % from"};
    ChartColumn high{"to"};
    for (const SourceCalibration& one : models[k].second) {
      source.texts.push_back(one.source);
      factor.numbers.push_back(one.factor);
      low.numbers.push_back(std::max(one.factor - kNormal95 * one.sd, 0.2 * one.factor));
      high.numbers.push_back(one.factor + kNormal95 * one.sd);
      if (std::find(chart.y.categories.begin(), chart.y.categories.end(), one.source) ==
          chart.y.categories.end()) {
        chart.y.categories.push_back(one.source);
      }
    }
    if (source.texts.empty()) continue;
    ChartLayer layer{LayerKind::intervals,
                     models.size() > 1 ? models[k].first : "",
                     {source, factor, low, high},
                     k + 1 < models.size() ? "2" : "1"};
    layer.offset = 12.0 * (static_cast<double>(k) - 0.5 * static_cast<double>(models.size() - 1));
    chart.layers.push_back(layer);
  }
  chart.height = bars_height(chart.y.categories.size());
  return chart;
}

Chart held_out_chart(const std::string& id, const std::vector<NamedHeldOut>& models) {
  Chart chart;
  chart.id = id;
  chart.title = "How far off held-out legs end";
  chart.caption =
      "Share of the legs, none of them seen by the fit, that end within a distance of where their "
      "landmark is. Further to the left is better. Dashed: the root mean square.";
  chart.x = {.title = "distance [mm]", .zero = true};
  chart.y = {.title = "legs within it [%]", .range = Range{0.0, 100.0}};
  chart.height = 260.0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const HeldOut& held = models[k].second;
    if (held.legs.empty()) continue;
    std::vector<double> distances;
    for (const LegPrediction& leg : held.legs) {
      distances.push_back(1000.0 * leg.arrival_error.norm());
    }
    const std::string colour = k + 1 < models.size() ? "2" : "1";
    const std::string name = models.size() > 1 ? models[k].first : "";
    add_shares(chart, name, std::move(distances), "mm", colour);
    ChartLayer rms{LayerKind::upright,
                   name.empty() ? "root mean square" : "",
                   {{"root mean square [mm]", {1000.0 * held.arrival_rms}}},
                   colour};
    rms.dashed = true;
    chart.layers.push_back(rms);
  }
  return chart;
}

Chart legs_chart(const std::string& id, const std::vector<LegMisfit>& legs, LegError which) {
  const bool stretch = which == LegError::stretch;
  Chart chart;
  chart.id = id;
  chart.title = stretch ? "Every leg: measured too long or too short"
                        : "Every leg: measured too far to the left or right";
  const auto shown_legs = thinned(legs.size(), kMostLegs);
  chart.caption = fmt::format(
      "{} of each leg against the fitted map, over time{}. Steps and slopes are the work of "
      "effects; a band of even width is noise.",
      stretch ? "Stretch error" : "Orientation error",
      shown_legs.size() < legs.size()
          ? fmt::format(" ({} of {} legs, the worst among them)", shown_legs.size(), legs.size())
          : "");
  const wording::ShownUnit unit = wording::shown_unit(stretch ? "" : "rad");
  chart.x.title = "time [s]";
  chart.y = {
      .title = std::string(stretch ? "stretch" : "orientation") + " error [" + unit.name + "]",
      .zero = true};
  chart.height = 260.0;
  chart.layers.push_back({LayerKind::level, "", {{"no error", {0.0}}}, "faint"});
  ChartColumn t{"time [s]"};
  ChartColumn error{chart.y.title};
  ChartColumn chi2{"chi\u00b2"};
  ChartColumn from{"from"};
  ChartColumn to{"to"};
  for (const std::size_t k : shown_legs) {
    const LegMisfit& leg = legs[k];
    t.numbers.push_back(leg.t);
    error.numbers.push_back(unit.factor * (stretch ? leg.stretch_error : leg.orientation_error));
    chi2.numbers.push_back(leg.chi2);
    from.texts.push_back(leg.from);
    to.texts.push_back(leg.to);
  }
  if (t.numbers.empty()) return chart;
  ChartLayer layer{LayerKind::dots, "", {t, error, from, to, chi2}, "1"};
  layer.size = t.size() > 300 ? 2.5 : 4.0;
  chart.layers.push_back(layer);
  return chart;
}

Chart worst_chart(const std::string& id, const std::vector<LegMisfit>& legs, std::size_t count) {
  Chart chart;
  chart.id = id;
  chart.title = "Worst legs";
  chart.caption =
      "Legs with the largest share of chi\u00b2: where the model and the measurements disagree "
      "most.";
  chart.x = {.title = "chi\u00b2 of the leg", .zero = true};
  ChartColumn name{"leg"};
  ChartColumn chi2{"chi\u00b2"};
  ChartColumn values{"values"};
  ChartColumn stretch{"stretch error [%]"};
  ChartColumn turned{"orientation error [\u00b0]"};
  for (std::size_t k = 0; k < std::min(count, legs.size()); ++k) {
    const LegMisfit& leg = legs[k];
    name.texts.push_back(fmt::format(
        "{}{:.0f} s", leg.from.empty() ? "" : leg.from + " \u2192 " + leg.to + ", ", leg.t));
    chi2.numbers.push_back(leg.chi2);
    values.numbers.push_back(leg.dof);
    stretch.numbers.push_back(100.0 * leg.stretch_error);
    turned.numbers.push_back(geometry::kDegrees * leg.orientation_error);
  }
  make_unique(name.texts);
  chart.y.categories = name.texts;
  chart.height = bars_height(name.texts.size());
  if (!name.texts.empty()) {
    chart.layers.push_back({LayerKind::bars, "", {name, chi2, values, stretch, turned}, "1"});
  }
  return chart;
}

}  // namespace trussmap::plot
