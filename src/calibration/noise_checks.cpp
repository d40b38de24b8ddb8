// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/end_moments.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kBadFit = 0.01;
constexpr double kBends = 0.2;  // some 2 x 0.2^2 = 8 % of k^2 by first-order figures

/// Squared Mahalanobis distances in some of the coordinates.
std::vector<double> squared_distances(const EndErrors& errors, const NoiseEstimate& estimate,
                                      const std::vector<int>& coordinates) {
  const Eigen::MatrixXd covariance = estimate.modelled(coordinates, coordinates);
  const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
  std::vector<double> result;
  for (const Eigen::Vector3d& e : errors) {
    const Eigen::VectorXd off = (e - estimate.centre)(coordinates);
    result.push_back(off.dot(factor.solve(off)));
  }
  return result;
}

EllipseCount count_inside(const std::vector<double>& distances, std::string coordinates,
                          int dimensions) {
  const double limit = std::pow(ellipse95_scale(dimensions), 2);
  EllipseCount result;
  result.coordinates = std::move(coordinates);
  result.runs = static_cast<int>(distances.size());
  result.inside = static_cast<int>(
      std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= limit; }));
  result.p_value = binomial_p_value(result.inside, result.runs, kConfidence);
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
    const double expected = chi2_cdf(distances[k], 3.0);
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
  return chi2_p_value(std::max(statistic, 0.0), 4);
}

/// How well the runs fit with their headings multiplied by a factor.
double shape_p_scaled(const EndErrors& errors, const NoiseExperiment& experiment, double factor) {
  EndErrors scaled = errors;
  for (Eigen::Vector3d& e : scaled) e[2] *= factor;
  try {
    const NoiseEstimate estimate = estimate_wheel_noise(scaled, experiment);
    return check_noise(scaled, experiment, estimate).shape_p_value;
  } catch (const SolveError&) {
    return 0.0;
  }
}

}  // namespace

double ellipse95_scale(int dimensions) {
  return std::sqrt(chi2_quantile(kConfidence, dimensions));
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
  fit.ellipses = {count_inside(squared_distances(errors, estimate, {0, 1}), "x-y", 2),
                  count_inside(squared_distances(errors, estimate, {0, 2}), "x-heading", 2),
                  count_inside(squared_distances(errors, estimate, {1, 2}), "y-heading", 2),
                  count_inside(squared_distances(errors, estimate, {0, 1, 2}), "x-y-heading", 3)};
  fit.distance_p_value = distance_p(squared_distances(errors, estimate, {0, 1, 2}));
  const double count = estimate.runs - (experiment.subtract_mean ? 1 : 0);
  fit.shape_p_value = shape_p(estimate, count);
  fit.nonlinear = nonlinear_share(experiment, estimate) > kBends;
  if (fit.nonlinear) {
    fit.distance_p_value = fit.shape_p_value = std::numeric_limits<double>::quiet_NaN();
  }
  double smallest = std::isnan(fit.distance_p_value) ? 1.0 : fit.distance_p_value;
  if (!std::isnan(fit.shape_p_value)) smallest = std::min(smallest, fit.shape_p_value);
  for (const EllipseCount& ellipse : fit.ellipses) smallest = std::min(smallest, ellipse.p_value);
  fit.good = smallest >= kBadFit;
  return fit;
}

std::vector<std::string> noise_doubts(const EndErrors& errors, const NoiseExperiment& experiment,
                                      const NoiseEstimate& estimate, const NoiseFit& fit) {
  constexpr double kImplausible = 0.1;  // m^1/2: a tenth of a metre after each metre
  constexpr double kSureMisfit = 1e-4;
  constexpr std::size_t kFewRuns = 10;
  constexpr double kFarthest = 30.0;  // squared distance; chi-square(3) exceeds it once in 700 000
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::vector<std::string> doubts;
  if (!experiment.subtract_mean && estimate.mean_p_value < kBadFit) {
    doubts.push_back(fmt::format(
        "the mean error ({:.3g} m, {:.3g} m, {:.3g} rad) is too far from 0 for noise (p = {:.1g}); "
        "remove the systematic errors first (umbmark), or leave the mean out (--subtract-mean)",
        estimate.mean[0], estimate.mean[1], estimate.mean[2], estimate.mean_p_value));
  }
  if (std::max(estimate.left.k, estimate.right.k) > kImplausible) {
    doubts.push_back(fmt::format(
        "k of {:.2g} m^1/2 is more than any usual wheel has; x, y are in metres and the heading "
        "in radians",
        std::max(estimate.left.k, estimate.right.k)));
  }
  const bool misfit = fit.shape_p_value < kSureMisfit;
  const bool degrees =
      (misfit || fit.nonlinear) && shape_p_scaled(errors, experiment, kDegree) > kBadFit;
  if (degrees) {
    doubts.push_back("the headings fit if they are degrees, not as the radians expected");
  } else if (misfit) {
    doubts.push_back(fmt::format(
        "noise of the two wheels alone does not spread the runs like this (p = {:.1g}); check "
        "the path, the wheelbase, the units (m, rad) and the sensor's own noise (--sensor-sd)",
        fit.shape_p_value));
  }
  if (fit.nonlinear && !degrees) {
    doubts.push_back(fmt::format(
        "noise this large bends the path: its end lags by {:.2g} m on average, and the papers' "
        "first-order figures are off; the exact ones hold, with standard errors that are some 10 % "
        "too small; drive a shorter path for sharper ones, \"2,-2\" for instance",
        end_moments(experiment.path, experiment.wheelbase,
                    {std::pow(estimate.left.k, 2), std::pow(estimate.right.k, 2)})
            .mean.head<2>()
            .norm()));
  }
  const std::vector<double> distances = squared_distances(errors, estimate, {0, 1, 2});
  const auto farthest = std::max_element(distances.begin(), distances.end());
  const double runs = static_cast<double>(distances.size());
  if (distances.size() >= kFewRuns && *farthest > std::max(kFarthest, 0.4 * runs)) {
    doubts.push_back(
        fmt::format("run {} ends far outside of all others and steers the result; was it measured "
                    "well, did a wheel slip?",
                    farthest - distances.begin() + 1));
  }
  if (distances.size() < kFewRuns) {
    doubts.push_back(fmt::format(
        "{} runs are few: the stated standard errors are too small, and a wheel's noise can seem "
        "to be 0; drive 30 runs or more",
        distances.size()));
  }
  const bool sensor = experiment.sensor_sd.maxCoeff() > 0.0;
  for (const double k : {estimate.left.k, estimate.right.k}) {
    if (k > 0.0) continue;
    doubts.push_back(sensor ? "the sensor's noise hides that of a wheel; drive a longer path, or "
                              "measure the ends better"
                            : "the noise of one wheel is lost in the scatter of the other's; drive "
                              "more runs");
    break;
  }
  return doubts;
}

}  // namespace trussmap
