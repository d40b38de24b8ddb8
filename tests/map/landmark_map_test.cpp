// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Routes and their averages.
#include "trussmap/landmark_map.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::landmark_map_test {
namespace {

constexpr double kPi = std::numbers::pi;

Traversal towards(double stretch, double orientation, double variance = 0.01) {
  return {stretch * Vector2(std::cos(orientation), std::sin(orientation)),
          variance * Matrix2::Identity()};
}

TEST(Route, AveragesAreThoseOfTheWholeList) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  Route route;
  double stretch = 0.0;
  double orientation = 0.0;
  Vector2 displacement = Vector2::Zero();
  Matrix2 covariance = Matrix2::Zero();
  for (int k = 1; k <= 30; ++k) {
    const double s = 3.0 + 0.2 * normal(random);
    const double angle = 1.0 + 0.1 * normal(random);
    const Traversal one = towards(s, angle, 0.01 * k);
    average_in(route, one);
    stretch += s;
    orientation += angle;
    displacement += one.displacement;
    covariance += one.covariance;
  }
  EXPECT_EQ(route.traversals, 30);
  EXPECT_NEAR(route.stretch, stretch / 30.0, 1e-13);
  EXPECT_NEAR(route.orientation, orientation / 30.0, 1e-13);
  EXPECT_LE((route.displacement - displacement / 30.0).norm(), 1e-13);
  EXPECT_LE((route.covariance - covariance / 30.0).norm(), 1e-14);
  EXPECT_GT(route.mean_vector().norm(), route.displacement.norm());  // a mean chord is short
}

/// Measured 3.1 and -3.1 rad: the mean is pi, not 0.
TEST(Route, OrientationsAreUnwrappedBeforeTheyAreAveraged) {
  Route route;
  average_in(route, towards(1.0, 3.1));
  average_in(route, towards(1.0, -3.1));
  EXPECT_NEAR(std::abs(wrap_angle(route.orientation)), kPi, 1e-12);
  EXPECT_NEAR(route.mean_vector().x(), -1.0, 1e-12);
}

TEST(Route, FoldsItsOrientationToHalfATurn) {
  EXPECT_NEAR(folded_orientation(-0.5), kPi - 0.5, 1e-15);
  EXPECT_NEAR(folded_orientation(kPi + 0.5), 0.5, 1e-15);
  EXPECT_EQ(folded_orientation(kPi), 0.0);
  for (const double angle : {-1e-17, -1e-300, 100.0, -100.0}) {
    EXPECT_GE(folded_orientation(angle), 0.0) << angle;
    EXPECT_LT(folded_orientation(angle), kPi) << angle;
  }
}

TEST(LandmarkGraph, ADriveBackCountsForTheSameRoute) {
  LandmarkGraph graph;
  const int a = graph.add_landmark("A", {0.0, 0.0});
  const int b = graph.add_landmark("B", {2.0, 1.0});
  const int route = graph.add_traversal(b, a, towards(2.0, 0.3));
  EXPECT_EQ(graph.add_traversal(a, b, reversed(towards(2.2, 0.5))), route);
  EXPECT_EQ(graph.routes(), 1);
  EXPECT_EQ(graph.route(route).source, b);
  EXPECT_EQ(graph.route(route).traversals, 2);
  EXPECT_NEAR(graph.route(route).stretch, 2.1, 1e-13);
  EXPECT_NEAR(graph.route(route).orientation, 0.4, 1e-13);
  EXPECT_EQ(graph.route_between(a, b), route);
  EXPECT_EQ(graph.routes_at(a), std::vector<int>{route});
  EXPECT_EQ(other_end(graph.route(route), b), a);
}

TEST(LandmarkGraph, RefusesTwinsAndLoops) {
  LandmarkGraph graph;
  const int a = graph.add_landmark("A", {0.0, 0.0});
  const int b = graph.add_landmark("B", {1.0, 0.0});
  graph.add_route(a, b);
  EXPECT_THROW(graph.add_landmark("A", {5.0, 5.0}), std::invalid_argument);
  EXPECT_THROW(graph.add_landmark("", {5.0, 5.0}), std::invalid_argument);
  EXPECT_THROW(graph.add_route(b, a), std::invalid_argument);
  EXPECT_THROW(graph.add_route(a, a), std::invalid_argument);
  EXPECT_THROW(graph.add_route(a, 7), std::invalid_argument);
  EXPECT_EQ(graph.find("C"), std::nullopt);
}

}  // namespace
}  // namespace trussmap::landmark_map_test
