// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The two systematic errors of a differential drive, and what undoes them.
//
//   E_d   D_R / D_L, ratio of the actual wheel diameters, right over left          -
//   E_b   actual over nominal wheelbase                                            -
//   c_L   factor for the left wheel's travel:  2 / (E_d + 1)                       -
//   c_R   factor for the right wheel's travel: 2 / (1/E_d + 1) = E_d c_L           -
//
// Borenstein & Feng (1996), eq. 2.3, 2.4, 4.29-4.33. The factors' mean is 1: the mean wheel size,
// which a tape along one straight drive gives, is not part of it.
// Factors of several rounds multiply, and are then brought back to a mean of 1.
#pragma once

#include "trussmap/effects/model.hpp"
#include "trussmap/recording/test_path.hpp"

#include <Eigen/Core>

namespace trussmap {

struct GeometryErrors {
  double diameter_ratio = 1.0;   ///< E_d
  double wheelbase_ratio = 1.0;  ///< E_b

  [[nodiscard]] double left_factor() const { return 2.0 / (diameter_ratio + 1.0); }
  [[nodiscard]] double right_factor() const { return diameter_ratio * left_factor(); }
};

/// What is found by a robot that already corrects for `in_force`, on top of that.
[[nodiscard]] GeometryErrors combined(const GeometryErrors& in_force, const GeometryErrors& found);

/// The effects `wheel diameter ratio` (channel difference, 2 (E_d - 1)/(E_d + 1)) and `wheelbase`
/// (channel turn, 1/E_b - 1) of the model; 1 and 1 where it has neither. Throws
/// std::invalid_argument where one of them has another channel or shape than these.
[[nodiscard]] GeometryErrors geometry_errors(const Model& model);

/// Puts them into the model, in place of what it said of them.
void set_geometry_errors(Model& model, const GeometryErrors& errors);

/// How a path's end differs from what the robot calculates (absolute - calculated), exactly.
struct PathError {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< m, m, rad
  /// d error / d (E_d, E_b).
  Eigen::Matrix<double, 3, 2> jacobian = Eigen::Matrix<double, 3, 2>::Zero();
};

/// A robot drives the path exactly by its own odometry, which takes the wheels as equal and the
/// wheelbase as `wheelbase` [m]; its true geometry is off by `errors`.
[[nodiscard]] PathError path_error(const TestPath& path, double wheelbase,
                                   const GeometryErrors& errors);

}  // namespace trussmap
