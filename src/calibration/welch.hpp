// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How sure a number is that rests on two independent samples (cw and ccw runs) of different
// scatter. The degrees of freedom of its standard error follow from the two variances of means
// (Welch 1947, Satterthwaite 1946):
//   se^2 = v1 + v2,   dof = (v1 + v2)^2 / (v1^2/(n1 - 1) + v2^2/(n2 - 1))
#pragma once

#include "trussmap/umbmark.hpp"

#include <vector>

#include <Eigen/Core>

namespace trussmap::calibration {

/// At least two points, else std::invalid_argument.
[[nodiscard]] SampleMean sample_mean(const std::vector<Eigen::Vector2d>& sample);

/// A quantity that depends on two samples' means through these gradients.
[[nodiscard]] Estimate welch_estimate(double value, const Eigen::Vector2d& gradient_a,
                                      const SampleMean& a, const Eigen::Vector2d& gradient_b,
                                      const SampleMean& b);

/// The same quantity where it also goes with another, independent one, by this slope.
[[nodiscard]] Estimate also_by(const Estimate& quantity, double slope, const Estimate& other);

/// Mean of a sample of two numbers or more, and its standard error.
[[nodiscard]] Estimate mean_of(const std::vector<double>& sample);

/// a + b of independent ones, the standard error's degrees of freedom as above.
[[nodiscard]] Estimate sum_of(const Estimate& a, const Estimate& b);

/// Two-sided, that an estimate as far from 0 is chance; NaN without scatter.
[[nodiscard]] double two_sided_p(const Estimate& estimate);

}  // namespace trussmap::calibration
