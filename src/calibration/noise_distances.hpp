// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far runs end from where the noise model has them, and from when on that is too far.
#pragma once

#include "calibration/end_moments.hpp"
#include "linalg/dense.hpp"
#include "trussmap/wheel_noise.hpp"

#include <vector>

namespace trussmap::calibration {

inline constexpr double kBadNoiseFit = 0.01;  ///< p-value

/// The planes in which ends are looked at, and the whole.
struct EndCoordinates {
  const char* name;
  std::vector<int> which;
};
[[nodiscard]] inline std::vector<EndCoordinates> end_coordinates() {
  return {
      {"x-y", {0, 1}}, {"x-heading", {0, 2}}, {"y-heading", {1, 2}}, {"x-y-heading", {0, 1, 2}}};
}

/// What is known of the measured ends' noise, m and rad.
[[nodiscard]] Matrix3 sensor_noise(const NoiseExperiment& experiment);

/// Of the ends as `squared`, k_L^2 and k_R^2 [m], have them, to the experiment's order. `shape`:
/// the path's.
[[nodiscard]] EndMoments end_moments(const NoiseExperiment& experiment, const NoiseShape& shape,
                                     const Vector2& squared);

/// Squared Mahalanobis distances in some of the coordinates, from an estimate or a StatedNoise.
template <typename Model>
[[nodiscard]] std::vector<double> squared_distances(const EndErrors& errors, const Model& model,
                                                    const std::vector<int>& coordinates) {
  const Eigen::MatrixXd covariance = model.modelled(coordinates, coordinates);
  const linalg::DenseLdlt factor(covariance);
  std::vector<double> result;
  for (const Eigen::Vector3d& e : errors) {
    const Eigen::VectorXd off = (e - model.centre)(coordinates);
    result.push_back(off.dot(factor.solve(off)));
  }
  return result;
}

}  // namespace trussmap::calibration
