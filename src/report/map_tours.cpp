// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/map_tours.hpp"

#include "geometry/units.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::report {
namespace {

struct TourQuantity {
  const char* id;
  const char* title;
  const char* axis;
  double factor;
  std::optional<double> (*pick)(const MapErrors&);
};

const TourQuantity kQuantities[] = {
    {"tours-stretch", "Routes too long or too short", "mean stretch error \u03c3 [%]", 100.0,
     [](const MapErrors& errors) { return std::optional(errors.stretch); }},
    {"tours-orientation", "Routes askew", "mean orientation error \u03c1 [\u00b0]",
     geometry::kDegrees, [](const MapErrors& errors) { return std::optional(errors.orientation); }},
    {"tours-position", "Landmarks off", "mean position error [m]", 1.0,
     [](const MapErrors& errors) { return errors.position; }}};

plot::Chart tours_chart(const std::vector<TourErrors>& tours, const TourQuantity& quantity) {
  plot::ChartLayer line{plot::LayerKind::line, "", {{"tour"}, {quantity.axis}}, "1"};
  plot::ChartLayer dots{plot::LayerKind::dots,
                        "",
                        {{"tour"}, {quantity.axis}, {"routes that count"}, {"driven"}},
                        "1"};
  dots.size = 3.5;
  for (std::size_t k = 0; k < tours.size(); ++k) {
    const std::optional<double> error = quantity.pick(tours[k].errors);
    if (!error) continue;
    for (plot::ChartLayer* layer : {&line, &dots}) {
      layer->columns[0].numbers.push_back(static_cast<double>(k + 1));
      layer->columns[1].numbers.push_back(quantity.factor * *error);
    }
    dots.columns[2].numbers.push_back(tours[k].errors.routes);
    dots.columns[3].texts.emplace_back(tours[k].complete ? "all routes once more"
                                                         : "a part: the recording ends");
  }
  plot::Chart chart;
  chart.id = quantity.id;
  chart.title = quantity.title;
  chart.caption =
      "Error of the map as it then was, after the best rotation and translation over the survey. "
      "Lower is better.";
  chart.x = {.title = "tour", .range = plot::Range{0.5, static_cast<double>(tours.size()) + 0.5}};
  chart.y = {.title = quantity.axis, .zero = true};
  chart.height = 300.0;
  if (line.columns[0].size() > 1) chart.layers.push_back(std::move(line));
  chart.layers.push_back(std::move(dots));
  return chart;
}

}  // namespace

PageSection tours_section(const BuiltMap& built) {
  ChartRow charts;
  for (const TourQuantity& one : kQuantities) {
    plot::Chart chart = tours_chart(built.tours, one);
    if (chart.layers.back().columns[0].size() > 0) charts.push_back(std::move(chart));
  }
  return {"On the way, tour by tour",
          {std::string("A tour ends when every route has been driven once more. The map is the one "
                       "that the robot had by then, judged by the survey."),
           std::move(charts)}};
}

}  // namespace trussmap::report
