// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/planar.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

// The mean of equal points differs from them by rounding, as a share of their size.
constexpr double kRounding = 1e-14;

Vector2 mean_of(const std::vector<Vector2>& points) {
  Vector2 sum = Vector2::Zero();
  for (const Vector2& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

Alignment align(const std::vector<Vector2>& points, const std::vector<Vector2>& onto,
                bool with_scale) {
  if (points.size() != onto.size() || points.size() < 2) {
    throw std::invalid_argument("an alignment takes two equally long lists of two points or more");
  }
  const Vector2 mean_a = mean_of(points);
  const Vector2 mean_b = mean_of(onto);
  double along = 0.0;
  double across = 0.0;
  double spread = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector2 a = points[k] - mean_a;
    const Vector2 b = onto[k] - mean_b;
    along += a.dot(b);
    across += quarter_turn(a).dot(b);
    spread += a.squaredNorm();
    size += points[k].squaredNorm();
  }
  Alignment result;
  result.angle = std::atan2(across, along);
  if (with_scale) {
    if (spread <= kRounding * kRounding * size) {
      throw std::invalid_argument("all points to be aligned coincide");
    }
    result.scale = std::hypot(along, across) / spread;
  }
  result.translation = mean_b - result.scale * (rotation(result.angle) * mean_a);
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    sum += (result.apply(points[k]) - onto[k]).squaredNorm();
  }
  result.rms = std::sqrt(sum / static_cast<double>(points.size()));
  return result;
}

}  // namespace

Alignment align_rigidly(const std::vector<Vector2>& points, const std::vector<Vector2>& onto) {
  return align(points, onto, false);
}

Alignment align_by_similarity(const std::vector<Vector2>& points,
                              const std::vector<Vector2>& onto) {
  return align(points, onto, true);
}

}  // namespace trussmap
