// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/noise_distances.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap {
using namespace calibration;

namespace {

SigmaCount count_within(const EndErrors& errors, const StatedNoise& stated,
                        const EndCoordinates& coordinates) {
  const std::vector<double> distances = squared_distances(errors, stated, coordinates.which);
  SigmaCount result;
  result.coordinates = coordinates.name;
  result.runs = static_cast<int>(errors.size());
  for (std::size_t k = 0; k < result.inside.size(); ++k) {
    const double limit = std::pow(static_cast<double>(k + 1), 2);
    result.inside[k] = static_cast<int>(
        std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= limit; }));
    result.expected[k] =
        result.runs * statistics::chi2_cdf(limit, static_cast<double>(coordinates.which.size()));
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
  const EndMoments moments =
      end_moments(experiment, noise_shape(experiment.path, experiment.wheelbase),
                  {k_left * k_left, k_right * k_right});
  StatedNoise result;
  result.left = k_left;
  result.right = k_right;
  result.modelled = moments.covariance + sensor_noise(experiment);
  result.centre = experiment.subtract_mean ? estimate.mean : moments.mean;
  for (const EndCoordinates& coordinates : end_coordinates()) {
    result.counts.push_back(count_within(errors, result, coordinates));
  }
  // S about where the model has the mean; a subtracted mean costs a run.
  const double count = estimate.runs - (experiment.subtract_mean ? 1.0 : 0.0);
  Matrix3 observed = Matrix3::Zero();
  for (const Eigen::Vector3d& e : errors) {
    observed += (e - result.centre) * (e - result.centre).transpose() / count;
  }
  const double worse =
      count * (loss(observed, result.modelled) - loss(estimate.observed, estimate.modelled));
  result.p_value = statistics::chi2_p_value(std::max(worse, 0.0), 2);
  return result;
}

}  // namespace trussmap
