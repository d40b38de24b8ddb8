// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether the noise model fits the runs it was fitted to.
//
// Ellipses: 95 % of the runs should end within the model's 95 % ellipse, in each plane and in all
// three coordinates. Distances: the squared Mahalanobis distances should be chi-square(3)
// (Kolmogorov-Smirnov; the constants come from the same runs, which makes the test a little
// forgiving). Shape: a covariance with two constants against one with all six entries free
// (likelihood ratio, chi-square(4), with Bartlett's correction): this one sees a wrong wheelbase,
// degrees for radians, or noise that is not the wheels'.
#pragma once

#include "trussmap/calibration/wheel_noise.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// How many runs are within the 95 % ellipse (or ellipsoid) of the model.
struct EllipseCount {
  std::string coordinates;  ///< "x-y", "x-heading", "y-heading", "x-y-heading"
  int inside = 0;
  int runs = 0;
  double p_value = 0.0;  ///< two-sided, of a count as far from 95 %
};

struct NoiseFit {
  std::vector<EllipseCount> ellipses;
  double distance_p_value = 0.0;  ///< Kolmogorov-Smirnov; NaN where the path bends
  double shape_p_value = 0.0;     ///< likelihood ratio; NaN there, and with fewer than 8 runs
  bool bends = false;             ///< bend_share above 0.2: the errors are not Gaussian
  bool good = false;              ///< no p-value below 0.01
};

/// How far the noise's own bend moves the mean end, in the standard deviations that it has by the
/// first order: of x or y, the larger.
[[nodiscard]] double bend_share(const NoiseExperiment& experiment, const NoiseEstimate& estimate);

[[nodiscard]] NoiseFit check_noise(const EndErrors& errors, const NoiseExperiment& experiment,
                                   const NoiseEstimate& estimate);

/// Doubts, a sentence each, that a person can act on: a systematic error, wrong units, a bad fit.
[[nodiscard]] std::vector<std::string> noise_doubts(const EndErrors& errors,
                                                    const NoiseExperiment& experiment,
                                                    const NoiseEstimate& estimate,
                                                    const NoiseFit& fit);

/// Square root of the 95 % quantile of chi-square: semi-axis of the ellipse per square root of the
/// covariance's eigenvalue. 2.4477 in a plane, 2.7955 in space.
[[nodiscard]] double ellipse95_scale(int dimensions);

}  // namespace trussmap
