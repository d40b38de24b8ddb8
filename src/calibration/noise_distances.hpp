// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far runs end from where the noise model has them, and from when on that is too far.
#pragma once

#include "linalg/dense.hpp"
#include "trussmap/wheel_noise.hpp"

#include <vector>

namespace trussmap {

inline constexpr double kBadNoiseFit = 0.01;  ///< p-value

/// What is known of the measured ends' noise, m and rad.
[[nodiscard]] Matrix3 sensor_noise(const NoiseExperiment& experiment);

/// Squared Mahalanobis distances in some of the coordinates, from an estimate or a StatedNoise.
template <typename Model>
[[nodiscard]] std::vector<double> squared_distances(const EndErrors& errors, const Model& model,
                                                    const std::vector<int>& coordinates) {
  const Eigen::MatrixXd covariance = model.modelled(coordinates, coordinates);
  const DenseLdlt factor(covariance);
  std::vector<double> result;
  for (const Eigen::Vector3d& e : errors) {
    const Eigen::VectorXd off = (e - model.centre)(coordinates);
    result.push_back(off.dot(factor.solve(off)));
  }
  return result;
}

}  // namespace trussmap
