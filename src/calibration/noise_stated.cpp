// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/end_moments.hpp"
#include "calibration/noise_distances.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
namespace {

EndMoments moments_of(const NoiseExperiment& experiment, const Vector2& squared) {
  if (experiment.order == NoiseOrder::exact) {
    return end_moments(experiment.path, experiment.wheelbase, squared);
  }
  const NoiseShape shape = noise_shape(experiment.path, experiment.wheelbase);
  return {Eigen::Vector3d::Zero(), squared[0] * shape.left + squared[1] * shape.right};
}

SigmaCount count_within(const EndErrors& errors, const StatedNoise& stated, std::string coordinates,
                        const std::vector<int>& which) {
  const std::vector<double> distances = squared_distances(errors, stated, which);
  SigmaCount result;
  result.coordinates = std::move(coordinates);
  result.runs = static_cast<int>(errors.size());
  for (std::size_t k = 0; k < result.inside.size(); ++k) {
    const double limit = std::pow(static_cast<double>(k + 1), 2);
    result.inside[k] = static_cast<int>(
        std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= limit; }));
    result.expected[k] = result.runs * chi2_cdf(limit, static_cast<double>(which.size()));
  }
  return result;
}

/// -2/n log likelihood.
double loss(const Matrix3& observed, const Matrix3& modelled) {
  return std::log(modelled.determinant()) + (modelled.inverse() * observed).trace();
}

}  // namespace

StatedNoise stated_noise(const EndErrors& errors, const NoiseExperiment& experiment,
                         const NoiseEstimate& estimate, double k_left, double k_right) {
  if (!(k_left > 0.0 && k_right > 0.0) || !std::isfinite(k_left + k_right)) {
    throw std::invalid_argument("k of both wheels must be above 0");
  }
  const EndMoments moments = moments_of(experiment, {k_left * k_left, k_right * k_right});
  StatedNoise result;
  result.left = k_left;
  result.right = k_right;
  result.modelled = moments.covariance + sensor_noise(experiment);
  result.centre = experiment.subtract_mean ? estimate.mean : moments.mean;
  result.counts = {count_within(errors, result, "x-y", {0, 1}),
                   count_within(errors, result, "x-heading", {0, 2}),
                   count_within(errors, result, "y-heading", {1, 2}),
                   count_within(errors, result, "x-y-heading", {0, 1, 2})};
  // S about where the model has the mean; a subtracted mean costs a run.
  const double count = estimate.runs - (experiment.subtract_mean ? 1.0 : 0.0);
  Matrix3 observed = Matrix3::Zero();
  for (const Eigen::Vector3d& e : errors) {
    observed += (e - result.centre) * (e - result.centre).transpose() / count;
  }
  const double worse =
      count * (loss(observed, result.modelled) - loss(estimate.observed, estimate.modelled));
  result.p_value = chi2_p_value(std::max(worse, 0.0), 2);
  return result;
}

}  // namespace trussmap
