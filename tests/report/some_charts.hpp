// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Charts with every kind of layer, and a name that means harm.
#pragma once

#include "plot/chart.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace trussmap::testing {

inline constexpr const char* kHostile =
    "</script><script>document.title='harmed'</script><!-- <img src=x "
    "onerror=\"document.title='harmed'\"> & \"quoted\" ]]>";

inline plot::Chart map_like_chart(const std::string& name) {
  plot::Chart chart;
  chart.id = "map-like";
  chart.title = "Map of " + name;
  chart.caption = "Caption of " + name;
  chart.x.title = "x [m]";
  chart.y.title = "y [m]";
  chart.equal_aspect = true;
  plot::ChartLayer bars{plot::LayerKind::segments,
                        "",
                        {{"x", {0, 5}},
                         {"y", {0, 0}},
                         {"x2", {5, 5}},
                         {"y2", {0, 5}},
                         {"from", {}, {name, "B"}},
                         {"force", {1, -2}}}};
  bars.shade = {0.5, -1.0};
  bars.key = {"pushes", "none", "pulls"};
  chart.layers = {
      bars,
      {plot::LayerKind::ellipses,
       "95 % ellipse",
       {{"x", {0}}, {"y", {0}}, {"a", {1}}, {"b", {0.5}}, {"angle", {0.3}}}},
      {plot::LayerKind::dots, "landmark", {{"x", {0, 5}}, {"y", {0, 5}}, {"", {}, {name, "B"}}}},
      {plot::LayerKind::labels, "", {{"x", {0, 5}}, {"y", {0, 5}}, {"", {}, {name, "B"}}}}};
  return chart;
}

inline plot::Chart line_like_chart(const std::string& name) {
  plot::Chart chart;
  chart.id = "line-like";
  chart.title = "Line of " + name;
  chart.x.title = name;
  chart.y = {.title = "error", .zero = true};
  std::vector<double> x, y, low, high;
  for (int k = 0; k < 30; ++k) {
    x.push_back(12.0 * k);
    y.push_back(std::sin(0.2 * k));
    low.push_back(y.back() - 0.2);
    high.push_back(y.back() + 0.2);
  }
  chart.layers = {
      {plot::LayerKind::level, "", {{"no error", {0}}}, "faint"},
      {plot::LayerKind::upright, "", {{"here", {100}}}, "faint"},
      {plot::LayerKind::band, "", {{"x", x}, {"low", low}, {"high", high}}, "2"},
      {plot::LayerKind::net, "", {{"x", x}, {"y", low}}, "faint"},
      {plot::LayerKind::intervals, name, {{"x", x}, {"y", y}, {"low", low}, {"high", high}}},
      {plot::LayerKind::line, name + " curve", {{"x", x}, {"y", y}}, "2"}};
  return chart;
}

inline plot::Chart bar_like_chart(const std::string& name) {
  plot::Chart chart;
  chart.id = "bar-like";
  chart.title = "Bars of " + name;
  chart.x = {.title = "size", .zero = true};
  chart.y.categories = {name + " one", name + " two"};
  chart.height = 100.0;
  chart.layers = {{plot::LayerKind::bars, name, {{"", {}, chart.y.categories}, {"size", {1, 2}}}}};
  return chart;
}

inline plot::Chart factor_like_chart(const std::string& name) {
  plot::Chart chart;
  chart.id = "factor-like";
  chart.title = "Factors of " + name;
  chart.x = {.title = "factor", .log = true};
  chart.y.categories = {"wheels", name};
  chart.height = 120.0;
  plot::ChartLayer before{
      plot::LayerKind::intervals,
      "before",
      {{"", {}, chart.y.categories}, {"factor", {1, 8}}, {"low", {0.8, 7}}, {"high", {1.2, 9}}},
      "2"};
  before.offset = 6.0;
  chart.layers = {{plot::LayerKind::upright, "as stated", {{"as stated", {1}}}, "faint"}, before};
  return chart;
}

inline std::vector<plot::Chart> charts_of_every_kind(const std::string& name) {
  return {map_like_chart(name), line_like_chart(name), bar_like_chart(name),
          factor_like_chart(name)};
}

}  // namespace trussmap::testing
