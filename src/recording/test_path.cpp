// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/test_path.hpp"

#include <cmath>
#include <numbers>

namespace trussmap {

TestPath square_path(double side, Direction direction) {
  const double quarter = direction == Direction::ccw ? std::numbers::pi / 2 : -std::numbers::pi / 2;
  TestPath path;
  for (int leg = 0; leg < 4; ++leg) {
    path.push_back({side, 0.0});
    path.push_back({0.0, quarter});
  }
  return path;
}

TestPath figure_eight_path(double radius) {
  const double circle = 2.0 * std::numbers::pi;
  return {{circle * radius, circle}, {circle * radius, -circle}};
}

double path_length(const TestPath& path) {
  double length = 0.0;
  for (const PathSegment& segment : path) length += std::abs(segment.distance);
  return length;
}

double largest_end_error(const TestPath& path, double wheelbase) {
  double longest = 0.0;
  for (const PathSegment& segment : path) {
    longest += std::abs(segment.distance) + 0.5 * wheelbase * std::abs(segment.turn);
  }
  return longest;
}

namespace {

/// Headings go as a cosine over the way: what it leads to is shorter by J0 of its amplitude.
double leg_length(const Waypoint& from, const Waypoint& to) {
  return (to.place - from.place).norm() / std::cyl_bessel_j(0.0, 0.5 * std::abs(to.bend));
}

}  // namespace

double plan_length(const DrivePlan& plan) {
  double sum = 0.0;
  for (std::size_t k = 1; k < plan.waypoints.size(); ++k) {
    sum += leg_length(plan.waypoints[k - 1], plan.waypoints[k]);
  }
  return sum;
}

double plan_duration(const DrivePlan& plan) {
  double sum = 0.0;
  for (std::size_t k = 0; k < plan.waypoints.size(); ++k) {
    const Waypoint& one = plan.waypoints[k];
    sum += one.stop;
    if (one.turn != 0.0) sum += std::abs(one.turn) / one.turn_rate;
    if (k > 0) sum += leg_length(plan.waypoints[k - 1], one) / one.speed;
  }
  return sum;
}

}  // namespace trussmap
