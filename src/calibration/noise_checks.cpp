// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/end_moments.hpp"
#include "calibration/noise_distances.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
using namespace calibration;

namespace {

constexpr double kConfidence = 0.95;
constexpr double kNonlinear = 0.2;  // some 2 x 0.2^2 = 8 % of k^2 at first order

EllipseCount count_inside(const std::vector<double>& distances, std::string coordinates,
                          int dimensions) {
  const double limit = std::pow(ellipse95_scale(dimensions), 2);
  EllipseCount result;
  result.coordinates = std::move(coordinates);
  result.runs = static_cast<int>(distances.size());
  result.inside = static_cast<int>(
      std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= limit; }));
  result.p_value = statistics::binomial_p_value(result.inside, result.runs, kConfidence);
  return result;
}

/// Kolmogorov's limiting law with Stephens' correction for small samples.
double kolmogorov_p(double distance, double count) {
  const double root = std::sqrt(count);
  const double lambda = (root + 0.12 + 0.11 / root) * distance;
  if (lambda < 0.2) return 1.0;
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) {
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
  }
  return std::clamp(sum, 0.0, 1.0);
}

double distance_p(std::vector<double> distances) {
  std::sort(distances.begin(), distances.end());
  const auto n = static_cast<double>(distances.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    const double expected = statistics::chi2_cdf(distances[k], 3.0);
    const auto rank = static_cast<double>(k);
    largest = std::max({largest, expected - rank / n, (rank + 1.0) / n - expected});
  }
  return kolmogorov_p(largest, n);
}

double shape_p(const NoiseEstimate& estimate, double count) {
  constexpr double kLeastCount = 7.0;
  if (count < kLeastCount) return std::numeric_limits<double>::quiet_NaN();
  const Matrix3 ratio = estimate.modelled.inverse() * estimate.observed;
  const double determinant = ratio.determinant();
  if (!(determinant > 0.0)) return 0.0;
  // Bartlett's factor for a covariance in three dimensions.
  const double bartlett = 1.0 - 6.5 / (6.0 * count);
  const double statistic = bartlett * count * (ratio.trace() - std::log(determinant) - 3.0);
  return statistics::chi2_p_value(std::max(statistic, 0.0), 4);
}

}  // namespace

double ellipse95_scale(int dimensions) {
  return std::sqrt(statistics::chi2_quantile(kConfidence, dimensions));
}

double nonlinear_share(const NoiseExperiment& experiment, const NoiseEstimate& estimate) {
  const Vector2 squared(std::pow(estimate.left.k, 2), std::pow(estimate.right.k, 2));
  const EndMoments exact = end_moments(experiment.path, experiment.wheelbase, squared);
  const NoiseShape shape = noise_shape(experiment.path, experiment.wheelbase);
  const Matrix3 first = squared[0] * shape.left + squared[1] * shape.right;
  double share = 0.0;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double sd = std::sqrt(first(k, k));
    if (sd > 0.0) share = std::max(share, std::abs(exact.mean[k]) / sd);
  }
  return share;
}

NoiseFit check_noise(const EndErrors& errors, const NoiseExperiment& experiment,
                     const NoiseEstimate& estimate) {
  NoiseFit fit;
  for (const auto& [name, which] : end_coordinates()) {
    fit.ellipses.push_back(count_inside(squared_distances(errors, estimate, which), name,
                                        static_cast<int>(which.size())));
  }
  fit.distance_p_value = distance_p(squared_distances(errors, estimate, {0, 1, 2}));
  const double count = estimate.runs - (experiment.subtract_mean ? 1 : 0);
  fit.shape_p_value = shape_p(estimate, count);
  fit.nonlinear = nonlinear_share(experiment, estimate) > kNonlinear;
  if (fit.nonlinear) {
    fit.distance_p_value = fit.shape_p_value = std::numeric_limits<double>::quiet_NaN();
  }
  double smallest = std::isnan(fit.distance_p_value) ? 1.0 : fit.distance_p_value;
  if (!std::isnan(fit.shape_p_value)) smallest = std::min(smallest, fit.shape_p_value);
  for (const EllipseCount& ellipse : fit.ellipses) smallest = std::min(smallest, ellipse.p_value);
  fit.good = smallest >= kBadNoiseFit;
  return fit;
}

NoiseAnalysis analyse_wheel_noise(EndErrors errors, NoiseExperiment experiment,
                                  const std::optional<Vector2>& stated) {
  NoiseAnalysis result;
  result.errors = std::move(errors);
  result.experiment = std::move(experiment);
  result.experiment.order = NoiseOrder::first;
  result.first_order = estimate_wheel_noise(result.errors, result.experiment);
  result.experiment.order = NoiseOrder::exact;
  result.exact = estimate_wheel_noise(result.errors, result.experiment);
  result.estimate = result.exact;
  if (!check_noise(result.errors, result.experiment, result.exact).nonlinear) {
    result.estimate = result.first_order;
    result.experiment.order = NoiseOrder::first;
  }
  result.fit = check_noise(result.errors, result.experiment, result.estimate);
  if (stated) {
    result.stated =
        stated_noise(result.errors, result.experiment, result.estimate, (*stated)[0], (*stated)[1]);
  }
  result.doubts = noise_doubts(result.errors, result.experiment, result.estimate, result.fit);
  return result;
}

}  // namespace trussmap
