// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The elastic paper's robot: it has no wheels, only an error per traversal of a route.
//
//   s, theta       true stretch [m] and orientation [rad] of the route as driven
//   s_m, theta_m   measured: s (1 + sigma_s e1) and theta + sigma_theta e2, with e standard normal
//   sigma          sqrt(pi/2) x mean absolute error
//   C              covariance, diag((sigma_s s_m)^2, (sigma_theta s_m)^2) along and across the
//                  measured route, turned into map axes
//
// Golfarelli, Maio & Rizzi (1998), section 4, give the mean absolute errors (5 % and 0.03 rad).
#pragma once

#include "trussmap/planar.hpp"

#include <random>

namespace trussmap::simulation {

/// Standard deviation of a normal error by its mean absolute value.
[[nodiscard]] double sd_of_mean_error(double mean_absolute_error);

/// Mean absolute errors of one traversal.
struct RouteErrors {
  double stretch = 0.05;      ///< fraction of the stretch
  double orientation = 0.03;  ///< rad
};

struct MeasuredRoute {
  Vector2 displacement = Vector2::Zero();  ///< m, map axes
  Matrix2 covariance = Matrix2::Zero();    ///< m^2, map axes
};

/// One traversal along `displacement` [m]. Throws std::invalid_argument on an error that is
/// negative or not finite.
[[nodiscard]] MeasuredRoute measure_route(const Vector2& displacement, const RouteErrors& errors,
                                          std::mt19937_64& random);

}  // namespace trussmap::simulation
