// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Laying one set of points over another, to judge a map whose frame is arbitrary.
//
// Minimises sum |s R a_k + v - b_k|^2 over the rotation R, the translation v and, if wanted, the
// scale s (Horn's closed form in the plane). Two points at least. Where all points coincide the
// angle is arbitrary (0) and there is no scale.
#pragma once

#include "trussmap/planar.hpp"

#include <vector>

namespace trussmap {

struct Alignment {
  double scale = 1.0;                     ///< multiplies the first set
  double angle = 0.0;                     ///< rad
  Vector2 translation = Vector2::Zero();  ///< m
  double rms = 0.0;                       ///< root mean square distance left, m

  [[nodiscard]] Vector2 apply(const Vector2& point) const {
    return scale * (rotation(angle) * point) + translation;
  }
};

/// Rotation and translation only. Throws std::invalid_argument on unequal sizes or < 2 points.
[[nodiscard]] Alignment align_rigidly(const std::vector<Vector2>& points,
                                      const std::vector<Vector2>& onto);

/// Rotation, translation and scale. Throws like align_rigidly, and where all points coincide.
[[nodiscard]] Alignment align_by_similarity(const std::vector<Vector2>& points,
                                            const std::vector<Vector2>& onto);

}  // namespace trussmap
