// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/correction/heading_reset.hpp"

namespace trussmap {

Traversal in_map_axes(const Motion& motion, const HeadingEstimate& start) {
  const Matrix2 R = rotation(start.heading);
  Traversal traversal;
  traversal.displacement = R * motion.displacement.position();
  const Vector2 swing = quarter_turn(traversal.displacement);
  traversal.covariance = R * motion.covariance.topLeftCorner<2, 2>() * R.transpose() +
                         start.variance * swing * swing.transpose();
  return traversal;
}

HeadingEstimate advanced(const HeadingEstimate& start, const Motion& motion) {
  return {start.heading + motion.displacement.heading, start.variance + motion.covariance(2, 2)};
}

double direction_variance(const Vector2& vector, const Matrix2& covariance) {
  const double length2 = vector.squaredNorm();
  const Vector2 across = quarter_turn(vector);
  return across.dot(covariance * across) / (length2 * length2);
}

HeadingEstimate reset_heading(const HeadingEstimate& heading, double innovation,
                              double route_variance) {
  const double total = heading.variance + route_variance;
  const double gain = total > 0.0 ? heading.variance / total : 0.0;
  return {heading.heading + gain * wrap_angle(innovation), heading.variance * (1.0 - gain)};
}

}  // namespace trussmap
