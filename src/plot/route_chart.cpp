// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/place.hpp"
#include "plot/fit_charts.hpp"
#include "plot/map_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace trussmap {

std::vector<RouteError> route_errors(const std::vector<LegMisfit>& legs, const FittedMap& map) {
  const Places places = places_of(map);
  std::map<std::pair<std::string, std::string>, RouteError> routes;
  for (const LegMisfit& leg : legs) {
    const auto from = places.find(leg.from);
    const auto to = places.find(leg.to);
    if (from == places.end() || to == places.end() || leg.from == leg.to) continue;
    const double length = (to->second - from->second).norm();
    const double along = length * leg.stretch_error;
    const double left = length * leg.orientation_error;
    if (!std::isfinite(along) || !std::isfinite(left)) continue;
    RouteError& route = routes[std::minmax(leg.from, leg.to)];
    if (route.legs == 0) {
      route.from = leg.from;
      route.to = leg.to;
    }
    ++route.legs;
    route.rms += along * along + left * left;
    route.along += along;
    route.left += left;
  }
  std::vector<RouteError> result;
  for (auto& [ends, route] : routes) {
    route.rms = std::sqrt(route.rms / route.legs);
    route.along /= route.legs;
    route.left /= route.legs;
    result.push_back(route);
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const RouteError& a, const RouteError& b) { return a.rms > b.rms; });
  return result;
}

Chart route_chart(const std::string& id, const std::string& title, const FittedMap& map,
                  const std::vector<RouteError>& routes, double worst) {
  Chart chart =
      map_chart(id, title, map,
                "Routes are coloured by how far off their legs end (root mean square), reckoned by "
                "the wheels alone from where the fit has them start: thin and grey is nothing, "
                "thick and red the most. With its other sensors the robot ends nearer.");
  const Places places = places_of(map);
  ChartLayer bars{LayerKind::segments,
                  "",
                  {{""},
                   {""},
                   {""},
                   {""},
                   {"from"},
                   {"to"},
                   {"legs"},
                   {"off by [mm]"},
                   {"too long by [mm]"},
                   {"to the left by [mm]"}}};
  bars.key = {"", "by wheels alone 0 mm off", fmt::format("{:.3g} mm off", 1e3 * worst)};
  std::vector<Vector2> net;
  const std::size_t drawn = std::min(kMostBars, routes.size());
  for (std::size_t k = drawn; k < routes.size(); ++k) {
    net.insert(net.end(),
               {places.at(routes[k].from), places.at(routes[k].to), Vector2(kAbsent, kAbsent)});
  }
  for (std::size_t k = drawn; k-- > 0;) {  // the worst last, above the others
    const RouteError& route = routes[k];
    const Vector2& from = places.at(route.from);
    const Vector2& to = places.at(route.to);
    const double numbers[] = {from.x(), from.y(), to.x(), to.y()};
    for (std::size_t c = 0; c < 4; ++c) bars.columns[c].numbers.push_back(numbers[c]);
    bars.columns[4].texts.push_back(route.from);
    bars.columns[5].texts.push_back(route.to);
    bars.columns[6].numbers.push_back(route.legs);
    bars.columns[7].numbers.push_back(1e3 * route.rms);
    bars.columns[8].numbers.push_back(1e3 * route.along);
    bars.columns[9].numbers.push_back(1e3 * route.left);
    bars.shade.push_back(worst > 0.0 ? std::min(1.0, route.rms / worst) : 0.0);
  }
  if (bars.shade.size() > 150) bars.size = 0.5;
  if (!net.empty()) chart.layers.push_back(net_layer("further routes", net));
  if (!bars.shade.empty()) chart.layers.push_back(std::move(bars));
  add_landmarks(chart, map);
  return chart;
}

void add_places(Chart& chart, const std::vector<Effect>& effects) {
  ChartLayer rings{LayerKind::ellipses,
                   "acts here",
                   {{"x [m]"}, {"y [m]"}, {"radius [m]"}, {""}, {""}, {"effect"}},
                   "bad"};
  for (const Effect& effect : effects) {
    const std::optional<Vector2> place = place_of(effect);
    if (!place) continue;
    const std::optional<double> radius = effect.shape.front().parameter("r");
    if (!radius || !(std::abs(*radius) > 0.0)) continue;
    const double numbers[] = {place->x(), place->y(), std::abs(*radius), std::abs(*radius), 0.0};
    for (std::size_t c = 0; c < 5; ++c) rings.columns[c].numbers.push_back(numbers[c]);
    rings.columns[5].texts.push_back(effect.name);
  }
  if (rings.columns[5].texts.empty()) return;
  rings.size = 3.0;
  chart.caption += " Ring: where the effect acts.";
  chart.layers.push_back(std::move(rings));
}

}  // namespace trussmap
