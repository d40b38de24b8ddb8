// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/map_layers.hpp"

#include "plot/layers.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr std::size_t kMostLandmarks = 200;  // drawn
constexpr std::size_t kMostMarksNamed = 60;

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

}  // namespace

Places places_of(const FittedMap& map) {
  Places places;
  for (const FittedLandmark& one : map.landmarks) places[one.name] = one.position;
  return places;
}

ChartLayer net_layer(const char* name, const std::vector<Vector2>& points) {
  ChartLayer layer{LayerKind::net, name, {{"x [m]"}, {"y [m]"}}, "faint"};
  for (const Vector2& p : points) {
    layer.columns[0].numbers.push_back(p.x());
    layer.columns[1].numbers.push_back(p.y());
  }
  return layer;
}

Chart map_chart(const std::string& id, const std::string& title, const FittedMap& map,
                const std::string& routes) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = map.landmarks.empty() ? "The robot's path as the fit has it."
                                        : routes +
                                              " Small ellipses hold the landmark with 95 % "
                                              "confidence, if the model is right.";
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
  return chart;
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

}  // namespace trussmap::plot
