// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a path with noisy wheels ends: mean and covariance, exactly.
//
// A heading error curves the path that follows: the end lags behind on average, and scatters along
// the path by the square of the heading error. The covariance of first order (trussmap/arc.hpp) has
// none of that; at 10 m out and back and k = 0.003 m^(1/2) it is as large as the wheels' own
// scatter along the path.
//
// With z = x + i y, u = e^(i heading) and wheel noise that comes evenly along the path,
//   dz = u (ds + dxi),  dheading = dphi + domega
// (a product of simultaneous noises counts half, Stratonovich's sense) E u and E u^2 are
// exponentials, and the second moments of z, u and the heading's error obey linear differential
// equations on each segment. They are integrated by Runge-Kutta steps of fourth order, to some 1e-9
// of their size.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/test_path.hpp"

#include <Eigen/Core>

namespace trussmap::calibration {

struct EndMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< of actual - calculated: m, m, rad
  Matrix3 covariance = Matrix3::Zero();            ///< in the frame of the start
};

/// `squared`: k_L^2 and k_R^2 [m]. Throws std::invalid_argument on a wheelbase not above 0.
[[nodiscard]] EndMoments end_moments(const TestPath& path, double wheelbase,
                                     const Vector2& squared);

}  // namespace trussmap::calibration
