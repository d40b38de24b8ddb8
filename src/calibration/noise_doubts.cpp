// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/end_moments.hpp"
#include "calibration/noise_distances.hpp"
#include "geometry/units.hpp"
#include "trussmap/error.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

using Doubts = std::vector<std::string>;

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

/// A systematic error, or k of no usual wheel.
void doubt_size(Doubts& doubts, const NoiseExperiment& experiment, const NoiseEstimate& estimate) {
  constexpr double kImplausible = 0.1;  // m^1/2: a tenth of a metre after each metre
  if (!experiment.subtract_mean && estimate.mean_p_value < kBadNoiseFit) {
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
}

/// Noise that is not the wheels', or too large for the first order.
void doubt_shape(Doubts& doubts, const EndErrors& errors, const NoiseExperiment& experiment,
                 const NoiseEstimate& estimate, const NoiseFit& fit) {
  constexpr double kSureMisfit = 1e-4;
  const bool misfit = fit.shape_p_value < kSureMisfit;
  const bool degrees = (misfit || fit.nonlinear) &&
                       shape_p_scaled(errors, experiment, geometry::kDegree) > kBadNoiseFit;
  if (degrees) {
    doubts.push_back("the headings fit if they are degrees, not as the radians expected");
  } else if (misfit) {
    doubts.push_back(fmt::format(
        "noise of the two wheels alone does not spread the runs like this (p = {:.1g}); check "
        "the path, the wheelbase, the units (m, rad) and the sensor's own noise (--sensor-sd)",
        fit.shape_p_value));
  }
  if (fit.nonlinear && !degrees) {
    doubts.push_back(
        fmt::format("noise this large moves the mean end by {:.2g} m, so that the paper's "
                    "first-order figures are "
                    "off; the exact ones hold, with standard errors that are some 10 % "
                    "too small; drive a shorter path for sharper ones, \"2,-2\" for instance",
                    end_moments(experiment.path, experiment.wheelbase,
                                {std::pow(estimate.left.k, 2), std::pow(estimate.right.k, 2)})
                        .mean.head<2>()
                        .norm()));
  }
}

/// Too few runs, one far outside of the others, or a wheel whose noise is hidden.
void doubt_runs(Doubts& doubts, const EndErrors& errors, const NoiseExperiment& experiment,
                const NoiseEstimate& estimate) {
  constexpr std::size_t kFewRuns = 10;
  constexpr double kFarthest = 30.0;  // squared distance; chi-square(3) exceeds it once in 700 000
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
  const bool sensor = sensor_noise(experiment).trace() > 0.0;
  for (const double k : {estimate.left.k, estimate.right.k}) {
    if (k > 0.0) continue;
    doubts.push_back(sensor ? "the sensor's noise hides that of a wheel; drive a longer path, or "
                              "measure the ends better"
                            : "the noise of one wheel is lost in the scatter of the other's; drive "
                              "more runs");
    break;
  }
}

}  // namespace

std::vector<std::string> noise_doubts(const EndErrors& errors, const NoiseExperiment& experiment,
                                      const NoiseEstimate& estimate, const NoiseFit& fit) {
  Doubts doubts;
  doubt_size(doubts, experiment, estimate);
  doubt_shape(doubts, errors, experiment, estimate, fit);
  doubt_runs(doubts, errors, experiment, estimate);
  return doubts;
}

}  // namespace trussmap
