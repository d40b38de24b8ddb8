// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/layers.hpp"

#include "linalg/dense.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace trussmap::plot {

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept;
  const std::size_t first = count <= most ? count : most / 4;
  for (std::size_t k = 0; k < first; ++k) kept.push_back(k);
  const std::size_t room = most - std::min(most, first);
  for (std::size_t k = 0; k < room && first < count; ++k) {
    kept.push_back(first + k * (count - first) / room);
  }
  return kept;
}

void make_unique(std::vector<std::string>& texts) {
  std::map<std::string, int> seen;
  for (std::string& text : texts) {
    const int times = ++seen[text];
    if (times > 1) text += " (" + std::to_string(times) + ")";
  }
}

void add_intervals(Chart& chart, const std::string& axis, const std::vector<NamedInterval>& rows) {
  chart.height = bars_height(rows.size());
  if (rows.empty()) return;
  ChartLayer layer{LayerKind::intervals, "", {{""}, {axis}, {"95 % from"}, {"to"}}, "1"};
  for (const NamedInterval& row : rows) {
    chart.y.categories.push_back(row.name);
    layer.columns[0].texts.push_back(row.name);
    layer.columns[1].numbers.push_back(row.value);
    layer.columns[2].numbers.push_back(row.value - row.half);
    layer.columns[3].numbers.push_back(row.value + row.half);
  }
  chart.layers.push_back(std::move(layer));
}

void add_shares(Chart& chart, const std::string& legend, std::vector<double> distances,
                const std::string& unit, const std::string& colour) {
  constexpr std::size_t kMostPoints = 300;
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  ChartLayer dots{
      LayerKind::dots, legend, {{"distance [" + unit + "]"}, {"within it [%]"}}, colour};
  const auto add = [&dots, &distances](std::size_t k) {
    dots.columns[0].numbers.push_back(distances[k]);
    dots.columns[1].numbers.push_back(100.0 * static_cast<double>(k + 1) /
                                      static_cast<double>(distances.size()));
  };
  const std::size_t step = 1 + distances.size() / kMostPoints;
  for (std::size_t k = 0; k + 1 < distances.size(); k += step) add(k);
  add(distances.size() - 1);
  dots.size = dots.columns[0].size() > 60 ? 1.5 : 3.0;
  ChartLayer line = dots;
  line.kind = LayerKind::line;
  line.size = 0.0;
  for (ChartColumn& column : line.columns) {
    column.numbers.insert(column.numbers.begin(), 0.0);
  }
  chart.layers.push_back(std::move(line));
  chart.layers.push_back(std::move(dots));
}

ChartLayer ellipse_layer(const std::string& legend, const std::vector<PlacedEllipse>& ellipses,
                         const std::string& colour) {
  ChartLayer layer{
      LayerKind::ellipses,
      legend,
      {{"x [m]"}, {"y [m]"}, {"larger semi-axis [m]"}, {"smaller [m]"}, {""}, {"landmark"}},
      colour};
  const double scale = ellipse95_scale(2);
  for (const PlacedEllipse& one : ellipses) {
    const linalg::PlanarModes axes = linalg::planar_modes(one.covariance);
    const double larger = axes.eigenvalues[1];
    if (!(larger > 0.0)) continue;
    const Vector2 along = axes.eigenvectors.col(1);
    layer.columns[0].numbers.push_back(one.centre.x());
    layer.columns[1].numbers.push_back(one.centre.y());
    layer.columns[2].numbers.push_back(scale * std::sqrt(larger));
    layer.columns[3].numbers.push_back(scale * std::sqrt(std::max(0.0, axes.eigenvalues[0])));
    layer.columns[4].numbers.push_back(std::atan2(along.y(), along.x()));
    layer.columns[5].texts.push_back(one.name);
  }
  return layer;
}

}  // namespace trussmap::plot
