// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"
#include "plot/layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kMostBars = 250;       // drawn one by one
constexpr std::size_t kMostLandmarks = 200;  // drawn
constexpr std::size_t kMostMarksNamed = 60;
/// chi^2/dof at which the strongest bar has the strongest colour: noise alone looks calm.
constexpr double kLoud = 9.0;

double strongest_force(const std::vector<RouteMisfit>& routes) {
  double most = 0.0;
  for (const RouteMisfit& route : routes) most = std::max(most, std::abs(route.force));
  return most > 0.0 ? most : 1.0;
}

ChartLayer net_layer(const char* name, const std::vector<Vector2>& points) {
  ChartLayer layer{LayerKind::net, name, {{"x [m]"}, {"y [m]"}}, "faint"};
  for (const Vector2& p : points) {
    layer.columns[0].numbers.push_back(p.x());
    layer.columns[1].numbers.push_back(p.y());
  }
  return layer;
}

using Places = std::map<std::string, Vector2>;

/// The bars that carry most, and all others as one net.
void add_bars(Chart& chart, const Places& places, std::vector<RouteMisfit> routes, double loudest) {
  std::stable_sort(routes.begin(), routes.end(), [](const RouteMisfit& a, const RouteMisfit& b) {
    return std::abs(a.force) > std::abs(b.force);
  });
  const Vector2 gap(kAbsent, kAbsent);
  std::vector<Vector2> net;
  ChartLayer bars{LayerKind::segments,
                  "",
                  {{""},
                   {""},
                   {""},
                   {""},
                   {"from"},
                   {"to"},
                   {"driven"},
                   {"bar force [1/m]"},
                   {"stretch error [%]"},
                   {"orientation error [\u00b0]"},
                   {"chi\u00b2"}}};
  bars.key = {"bar pushes", "no force", "bar pulls"};
  for (const RouteMisfit& route : routes) {
    const auto from = places.find(route.from);
    const auto to = places.find(route.to);
    if (from == places.end() || to == places.end()) continue;
    if (bars.shade.size() == kMostBars) {
      net.insert(net.end(), {from->second, to->second, gap});
      continue;
    }
    const double numbers[] = {from->second.x(), from->second.y(), to->second.x(), to->second.y()};
    for (std::size_t k = 0; k < 4; ++k) bars.columns[k].numbers.push_back(numbers[k]);
    bars.columns[4].texts.push_back(route.from);
    bars.columns[5].texts.push_back(route.to);
    bars.columns[6].numbers.push_back(route.traversals);
    bars.columns[7].numbers.push_back(route.force);
    bars.columns[8].numbers.push_back(100.0 * route.stretch_error);
    bars.columns[9].numbers.push_back(route.orientation_error * 180.0 / std::numbers::pi);
    bars.columns[10].numbers.push_back(route.chi2);
    bars.shade.push_back(route.force / loudest);
  }
  if (bars.shade.size() > 150) bars.size = 0.5;
  if (!net.empty()) chart.layers.push_back(net_layer("further routes", net));
  // The strongest last, above the others.
  std::reverse(bars.shade.begin(), bars.shade.end());
  for (ChartColumn& column : bars.columns) {
    std::reverse(column.numbers.begin(), column.numbers.end());
    std::reverse(column.texts.begin(), column.texts.end());
  }
  if (!bars.shade.empty()) chart.layers.push_back(std::move(bars));
}

/// All landmarks, or those that are least sure.
std::vector<FittedLandmark> drawn_landmarks(const FittedMap& map) {
  std::vector<FittedLandmark> drawn = map.landmarks;
  if (drawn.size() <= kMostLandmarks) return drawn;
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const FittedLandmark& a, const FittedLandmark& b) {
                     return a.covariance.trace() > b.covariance.trace();
                   });
  drawn.resize(kMostLandmarks);
  return drawn;
}

void add_landmarks(Chart& chart, const FittedMap& map) {
  ChartLayer dots{LayerKind::dots, "landmark", {{"x [m]"}, {"y [m]"}, {"landmark"}}, "ink"};
  ChartLayer surveyed{
      LayerKind::dots, "as surveyed", {{"x [m]"}, {"y [m]"}, {"surveyed landmark"}}, "3"};
  ChartLayer names{LayerKind::labels, "", {{"x [m]"}, {"y [m]"}, {"landmark"}}, "muted"};
  std::vector<PlacedEllipse> ellipses;
  const bool few = map.landmarks.size() <= kMostMarksNamed;
  for (const FittedLandmark& one : drawn_landmarks(map)) {
    const auto add = [&one](ChartLayer& layer, const Vector2& at) {
      layer.columns[0].numbers.push_back(at.x());
      layer.columns[1].numbers.push_back(at.y());
      layer.columns[2].texts.push_back(one.name);
    };
    ellipses.push_back({one.name, one.position, one.covariance});
    add(dots, one.position);
    if (one.survey) add(surveyed, *one.survey);
    if (few) add(names, one.position);
  }
  dots.size = few ? 3.5 : 2.0;
  surveyed.size = few ? 5.5 : 3.0;
  if (!surveyed.columns[2].texts.empty()) chart.layers.push_back(std::move(surveyed));
  ChartLayer ellipse = ellipse_layer("95 % ellipse", ellipses, "1");
  if (!ellipse.columns[0].numbers.empty()) chart.layers.push_back(std::move(ellipse));
  if (!dots.columns[2].texts.empty()) chart.layers.push_back(std::move(dots));
  if (!names.columns[2].texts.empty()) chart.layers.push_back(std::move(names));
}

}  // namespace

double loudest_force(const Comparison& comparison) {
  return strongest_force(comparison.routes) *
         std::sqrt(std::max(1.0, kLoud / std::max(1.0, comparison.misfit())));
}

Chart truss_chart(const std::string& id, const std::string& title, const FittedMap& map,
                  const std::vector<RouteMisfit>& routes, double loudest) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = map.landmarks.empty()
                      ? "The robot's path as the fit has it."
                      : "Routes are the bars of a truss, landmarks its joints. A red bar pulls its "
                        "landmarks together, a blue one pushes them apart: there the measurements "
                        "of the route disagree with all others. Small ellipses hold the landmark "
                        "with 95 % confidence, if the model is right.";
  if (map.landmarks.size() > kMostLandmarks) {
    chart.caption += fmt::format(" Shown are the {} landmarks least sure, of {}.", kMostLandmarks,
                                 map.landmarks.size());
  }
  chart.x.title = "x [m]";
  chart.y.title = "y [m]";
  chart.equal_aspect = true;
  chart.height = 480.0;
  std::vector<Vector2> path;
  for (const std::vector<Vector2>& one : map.paths) {
    path.insert(path.end(), one.begin(), one.end());
    path.emplace_back(kAbsent, kAbsent);
  }
  if (!path.empty()) chart.layers.push_back(net_layer("path driven", path));
  Places places;
  for (const FittedLandmark& one : map.landmarks) places[one.name] = one.position;
  add_bars(chart, places, routes, loudest);
  add_landmarks(chart, map);
  return chart;
}

}  // namespace trussmap
