// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/route_robot.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace trussmap::simulation {

double sd_of_mean_error(double mean_absolute_error) {
  return std::sqrt(std::numbers::pi / 2.0) * mean_absolute_error;
}

MeasuredRoute measure_route(const Vector2& displacement, const RouteErrors& errors,
                            std::mt19937_64& random) {
  for (const double error : {errors.stretch, errors.orientation}) {
    if (!std::isfinite(error) || error < 0.0) {
      throw std::invalid_argument("a mean absolute error must be a number of 0 or more");
    }
  }
  const double sd_stretch = sd_of_mean_error(errors.stretch);
  const double sd_orientation = sd_of_mean_error(errors.orientation);
  std::normal_distribution<double> normal;
  const double e1 = normal(random);
  const double e2 = normal(random);
  const double stretch = displacement.norm() * (1.0 + sd_stretch * e1);
  const double orientation = direction(displacement) + sd_orientation * e2;

  const Matrix2 R = rotation(orientation);
  const Vector2 sd_route = stretch * Vector2(sd_stretch, sd_orientation);
  MeasuredRoute measured;
  measured.displacement = R * Vector2(stretch, 0.0);
  measured.covariance = R * sd_route.cwiseAbs2().asDiagonal() * R.transpose();
  return measured;
}

}  // namespace trussmap::simulation
