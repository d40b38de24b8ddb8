// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/heading_reset.hpp"

namespace trussmap::map {

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

HeadingEstimate with_reading(const std::optional<HeadingEstimate>& known,
                             const HeadingEstimate& reading) {
  if (!known) return reading;
  return reset_heading(*known, reading.heading - known->heading, reading.variance);
}

}  // namespace trussmap::map
