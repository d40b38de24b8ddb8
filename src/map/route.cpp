// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/landmark_map.hpp"

#include <cmath>
#include <numbers>

namespace trussmap {

Traversal reversed(const Traversal& traversal) {
  return {-traversal.displacement, traversal.covariance};
}

Vector2 Route::mean_vector() const {
  return stretch * Vector2(std::cos(orientation), std::sin(orientation));
}

void average_in(Route& route, const Traversal& traversal) {
  const double measured = direction(traversal.displacement);
  const double orientation =
      route.traversals == 0 ? measured : unwrap_near(measured, route.orientation);
  ++route.traversals;
  const double weight = 1.0 / route.traversals;
  route.stretch += weight * (traversal.displacement.norm() - route.stretch);
  route.orientation += weight * (orientation - route.orientation);
  route.displacement += weight * (traversal.displacement - route.displacement);
  route.covariance += weight * (traversal.covariance - route.covariance);
}

double folded_orientation(double orientation) {
  const double folded = std::fmod(orientation, std::numbers::pi);
  const double positive = folded < 0.0 ? folded + std::numbers::pi : folded;
  return positive < std::numbers::pi ? positive : 0.0;
}

}  // namespace trussmap
