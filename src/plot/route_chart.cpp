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

namespace trussmap::plot {

namespace {

/// Errors of legs, m, along their routes and to the left, gathered by route.
class RouteGatherer {
 public:
  explicit RouteGatherer(const FittedMap& map) : places_(places_of(map)) {}

  /// `error`: of a route's length from one end to the other, by its direction.
  template <typename Error>
  void add(const std::string& from, const std::string& to, int legs, const Error& error) {
    const auto begin = places_.find(from);
    const auto end = places_.find(to);
    if (begin == places_.end() || end == places_.end() || from == to) return;
    const Vector2 off = error(Vector2(end->second - begin->second));
    if (!off.allFinite()) return;
    RouteError& route = routes_[std::minmax(from, to)];
    if (route.from.empty()) {
      route.from = from;
      route.to = to;
    }
    route.legs += legs;
    route.rms += legs * off.squaredNorm();
    route.along += legs * off.x();
    route.left += legs * off.y();
  }

  /// The worst first.
  [[nodiscard]] std::vector<RouteError> routes() const {
    std::vector<RouteError> result;
    for (const auto& [ends, sum] : routes_) {
      RouteError route = sum;
      const double legs = std::max(1, route.legs);
      route.rms = std::sqrt(route.rms / legs);
      route.along /= legs;
      route.left /= legs;
      result.push_back(route);
    }
    std::stable_sort(result.begin(), result.end(), [](const RouteError& a, const RouteError& b) {
      return std::pair(a.legs > 0, a.rms) > std::pair(b.legs > 0, b.rms);
    });
    return result;
  }

 private:
  Places places_;
  std::map<std::pair<std::string, std::string>, RouteError> routes_;
};

}  // namespace

std::vector<RouteError> route_errors(const std::vector<LegMisfit>& legs, const FittedMap& map) {
  RouteGatherer routes(map);
  for (const LegMisfit& leg : legs) {
    routes.add(leg.from, leg.to, 1, [&leg](const Vector2& way) {
      return Vector2(way.norm() * Vector2(leg.stretch_error, leg.orientation_error));
    });
  }
  return routes.routes();
}

std::vector<RouteError> held_out_errors(const std::vector<LegPrediction>& legs,
                                        const std::vector<LegMisfit>& all, const FittedMap& map) {
  RouteGatherer routes(map);
  for (const LegPrediction& leg : legs) {
    routes.add(leg.from, leg.to, 1, [&leg](const Vector2& way) {
      const Vector2 ahead = way.normalized();
      return Vector2(ahead.dot(leg.arrival_error), quarter_turn(ahead).dot(leg.arrival_error));
    });
  }
  for (const LegMisfit& leg : all) {
    routes.add(leg.from, leg.to, 0, [](const Vector2&) { return Vector2(Vector2::Zero()); });
  }
  return routes.routes();
}

RouteColours by_wheels_alone(double worst) {
  return {worst,
          "Routes are coloured by how far off their legs end (root mean square), reckoned by "
          "the wheels alone from where the fit has them start: thin and grey is nothing, "
          "thick and red the most. With its other sensors the robot ends nearer.",
          fmt::format("{:.3g} mm off by wheels alone", 1e3 * worst)};
}

RouteColours by_held_out_legs(double first) {
  const double worst = 2.0 * first;
  return {worst,
          "Routes are coloured by how far off their held-out legs end (root mean square), as the "
          "number above is of all of them: thin and grey is nothing, thick and red twice what it "
          "was at the first step. Faint: no leg of that route is held out.",
          fmt::format("{:.3g} mm off at a leg's end", 1e3 * worst)};
}

Chart route_chart(const std::string& id, const std::string& title, const FittedMap& map,
                  const std::vector<RouteError>& routes, const RouteColours& colours) {
  Chart chart = map_chart(id, title, map, colours.caption);
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
  bars.key = {"", "0 mm", colours.key};
  std::vector<Vector2> net;
  const auto judged = std::partition_point(routes.begin(), routes.end(),
                                           [](const RouteError& one) { return one.legs > 0; });
  const std::size_t drawn = std::min(kMostBars, static_cast<std::size_t>(judged - routes.begin()));
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
    bars.shade.push_back(colours.worst > 0.0 ? std::min(1.0, route.rms / colours.worst) : 0.0);
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
    const std::optional<Vector2> place = effects::place_of(effect);
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

}  // namespace trussmap::plot
