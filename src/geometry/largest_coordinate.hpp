// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How large the coordinates of a map are, at least 1: what their rounding is relative to.
#pragma once

#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trussmap::geometry {

[[nodiscard]] inline double largest_coordinate(const std::vector<Vector2>& points) {
  double largest = 1.0;
  for (const Vector2& at : points) largest = std::max(largest, at.cwiseAbs().maxCoeff());
  return largest;
}

/// Headings, as they are, among them.
[[nodiscard]] inline double largest_coordinate(const std::vector<Pose>& poses) {
  double largest = 1.0;
  for (const Pose& pose : poses) {
    largest = std::max({largest, std::abs(pose.x), std::abs(pose.y), std::abs(pose.heading)});
  }
  return largest;
}

}  // namespace trussmap::geometry
