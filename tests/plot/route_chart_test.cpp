// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::route_chart_test {
using namespace plot;
namespace {

FittedMap triangle() {
  FittedMap map;
  const std::vector<Vector2> places{{0.0, 0.0}, {3.0, 4.0}, {3.0, 0.0}};
  const std::vector<std::string> names{"a", "b", "c"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    FittedLandmark one;
    one.name = names[k];
    one.position = places[k];
    map.landmarks.push_back(one);
  }
  return map;
}

LegMisfit leg(const char* from, const char* to, double stretch, double orientation) {
  LegMisfit one;
  one.from = from;
  one.to = to;
  one.stretch_error = stretch;
  one.orientation_error = orientation;
  return one;
}

TEST(RouteErrors, AreMetresAtTheEndOfTheRoutesLegs) {
  // a - b is 5 m long: 1 % is 50 mm, 0.02 rad are 100 mm.
  const auto routes = route_errors(
      {leg("a", "b", 0.01, 0.0), leg("b", "a", 0.01, 0.02), leg("a", "c", -0.01, 0.0),
       leg("a", "unknown", 1.0, 1.0), leg("a", "a", 1.0, 1.0), leg("c", "b", std::nan(""), 0.0)},
      triangle());
  ASSERT_EQ(routes.size(), 2U);
  EXPECT_EQ(routes[0].legs, 2);  // the worst first, both ways one route
  EXPECT_NEAR(routes[0].rms, std::sqrt((0.05 * 0.05 + 0.05 * 0.05 + 0.1 * 0.1) / 2.0), 1e-12);
  EXPECT_NEAR(routes[0].along, 0.05, 1e-12);
  EXPECT_NEAR(routes[0].left, 0.05, 1e-12);
  EXPECT_EQ(routes[1].from, "a");
  EXPECT_EQ(routes[1].to, "c");
  EXPECT_NEAR(routes[1].rms, 0.03, 1e-12);
}

LegPrediction held_out(const char* from, const char* to, const Vector2& error) {
  LegPrediction one;
  one.from = from;
  one.to = to;
  one.arrival_error = error;
  return one;
}

TEST(RouteErrors, OfHeldOutLegsAreWhereTheyArePredictedToEnd) {
  // c - b goes up: 0.03 m up is too far along, 0.04 m to the right of the picture is to its right.
  const auto routes =
      held_out_errors({held_out("c", "b", {0.04, 0.03})},
                      {leg("c", "b", 0.5, 0.0), leg("a", "c", 0.5, 0.0)}, triangle());
  ASSERT_EQ(routes.size(), 2U);
  EXPECT_EQ(routes[0].legs, 1);
  EXPECT_NEAR(routes[0].rms, 0.05, 1e-12);
  EXPECT_NEAR(routes[0].along, 0.03, 1e-12);
  EXPECT_NEAR(routes[0].left, -0.04, 1e-12);
  EXPECT_EQ(routes[1].legs, 0);  // no leg of it is held out
  const Chart chart = route_chart("map", "Map", triangle(), routes, by_held_out_legs(0.1));
  for (const ChartLayer& layer : chart.layers) {
    if (layer.kind != LayerKind::segments) continue;
    ASSERT_EQ(layer.shade.size(), 1U);
    EXPECT_NEAR(layer.shade[0], 0.25, 1e-12);  // of twice 0.1 m
    EXPECT_EQ(layer.key[2], "200 mm off at a leg's end");
  }
}

TEST(RouteChart, ColoursFromNothingToTheWorst) {
  const FittedMap map = triangle();
  const auto routes = route_errors({leg("a", "b", 0.02, 0.0), leg("a", "c", 0.0, 0.0)}, map);
  const Chart chart = route_chart("map", "Map", map, routes, by_wheels_alone(routes.front().rms));
  const ChartLayer* bars = nullptr;
  for (const ChartLayer& layer : chart.layers) {
    if (layer.kind == LayerKind::segments) bars = &layer;
  }
  ASSERT_NE(bars, nullptr);
  EXPECT_EQ(bars->shade, (std::vector<double>{0.0, 1.0}));  // the worst is drawn last
  EXPECT_EQ(bars->key, (std::vector<std::string>{"", "0 mm", "100 mm off by wheels alone"}));
  EXPECT_NO_THROW(static_cast<void>(chart_json(chart)));
}

TEST(RouteChart, RingsThePlacesThatEffectsActAt) {
  const Effect wide{"hard iron", Channel::compass, {"sin(heading)", "cos(heading)"}, {0.1, 0.1}};
  Effect patch{"slippery patch", Channel::wheels, {}, {0.08}};
  patch.shape.push_back(
      Shape("(1+sign({r}^2-(x-{x})^2-(y-{y})^2))/2", {{"x", 1.5}, {"y", 2.0}, {"r", 0.7}}));
  Chart chart = route_chart("map", "Map", triangle(), {}, by_wheels_alone(1.0));
  const std::size_t before = chart.layers.size();
  add_places(chart, {wide});
  EXPECT_EQ(chart.layers.size(), before);
  add_places(chart, {wide, patch});
  ASSERT_EQ(chart.layers.size(), before + 1);
  const ChartLayer& ring = chart.layers.back();
  const std::vector<double> expected{1.5, 2.0, 0.7, 0.7, 0.0};
  for (std::size_t c = 0; c < expected.size(); ++c) {
    EXPECT_EQ(ring.columns[c].numbers, std::vector<double>{expected[c]});
  }
  EXPECT_NO_THROW(static_cast<void>(chart_json(chart)));
}

TEST(RouteChart, ManyRoutesAreOneNetBesideTheWorst) {
  FittedMap map;
  std::vector<LegMisfit> legs;
  for (int k = 0; k < 400; ++k) {
    FittedLandmark one;
    one.name = std::to_string(k);
    one.position = Vector2(k, 0.0);
    map.landmarks.push_back(one);
    if (k > 0) {
      legs.push_back(leg(std::to_string(k - 1).c_str(), one.name.c_str(), 1e-4 * k, 0.0));
    }
  }
  const auto routes = route_errors(legs, map);
  ASSERT_EQ(routes.size(), 399U);
  const Chart chart = route_chart("map", "Map", map, routes, by_wheels_alone(routes.front().rms));
  std::size_t drawn = 0;
  bool net = false;
  for (const ChartLayer& layer : chart.layers) {
    if (layer.kind == LayerKind::segments) drawn = layer.columns[0].size();
    net = net || (layer.kind == LayerKind::net && layer.name == "further routes");
  }
  EXPECT_EQ(drawn, 250U);
  EXPECT_TRUE(net);
}

}  // namespace
}  // namespace trussmap::route_chart_test
