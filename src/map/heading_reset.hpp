// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Without a compass: the heading is dead-reckoned, and taken from the map again whenever the robot
// has driven a route that the map knows.
//
//   V           variance of the heading accumulated since the last reset                 rad^2
//   W           variance of the route's orientation, from the map and this traversal     rad^2
//   innovation  orientation of the route in the map - measured orientation               rad
//   gain        V/(V + W);   heading += gain innovation,   V *= 1 - gain
//
// Landmark positions alone do not carry the heading; with this reset the elastic truss stays
// bounded, without it its errors grow for ever.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>

namespace trussmap::map {

/// Variance of a vector's direction: its covariance across it over its squared length, rad^2.
[[nodiscard]] double direction_variance(const Vector2& vector, const Matrix2& covariance);

/// The reset. `route_variance` = W, `innovation` is wrapped here.
[[nodiscard]] HeadingEstimate reset_heading(const HeadingEstimate& heading, double innovation,
                                            double route_variance);

/// What is known of the heading together with a reading of it; nothing known: the reading.
[[nodiscard]] HeadingEstimate with_reading(const std::optional<HeadingEstimate>& known,
                                           const HeadingEstimate& reading);

}  // namespace trussmap::map
