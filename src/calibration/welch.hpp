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

namespace trussmap {

/// At least two points, else std::invalid_argument.
[[nodiscard]] SampleMean sample_mean(const std::vector<Eigen::Vector2d>& sample);

/// A quantity that depends on two samples' means through these gradients.
[[nodiscard]] Estimate welch_estimate(double value, const Eigen::Vector2d& gradient_a,
                                      const SampleMean& a, const Eigen::Vector2d& gradient_b,
                                      const SampleMean& b);

}  // namespace trussmap
