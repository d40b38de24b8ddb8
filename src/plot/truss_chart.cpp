// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "plot/fit_charts.hpp"
#include "plot/map_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

/// chi^2/dof at which the strongest bar has the strongest colour: noise alone looks calm.
constexpr double kLoud = 9.0;

double strongest_force(const std::vector<RouteMisfit>& routes) {
  double most = 0.0;
  for (const RouteMisfit& route : routes) most = std::max(most, std::abs(route.force));
  return most > 0.0 ? most : 1.0;
}

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
    bars.columns[9].numbers.push_back(route.orientation_error * geometry::kDegrees);
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

}  // namespace

double loudest_force(const Comparison& comparison) {
  return strongest_force(comparison.routes) *
         std::sqrt(std::max(1.0, kLoud / std::max(1.0, comparison.misfit())));
}

Chart truss_chart(const std::string& id, const std::string& title, const FittedMap& map,
                  const std::vector<RouteMisfit>& routes, double loudest) {
  Chart chart = map_chart(id, title, map,
                          "Routes are the bars of a truss, landmarks its joints. A red bar pulls "
                          "its landmarks together, "
                          "a blue one pushes them apart: there the measurements of the route "
                          "disagree with all others.");
  add_bars(chart, places_of(map), routes, loudest);
  add_landmarks(chart, map);
  return chart;
}

}  // namespace trussmap::plot
