// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A number with how sure it is: value, standard error and the degrees of freedom behind that error.
//
// Two independent samples (cw and ccw runs) of different scatter give a standard error whose
// degrees of freedom follow from the two variances of means (Welch 1947, Satterthwaite 1946):
//   se^2 = v1 + v2,   dof = (v1 + v2)^2 / (v1^2/(n1 - 1) + v2^2/(n2 - 1))
#pragma once

#include <vector>

#include <Eigen/Core>

namespace trussmap {

struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
  double dof = 0.0;  ///< 0: there is no scatter to judge by, or none was needed
};

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Two-sided interval by Student's t. `confidence` in (0, 1).
[[nodiscard]] Interval confidence_interval(const Estimate& estimate, double confidence = 0.95);

/// Mean of a sample of plane vectors, and its covariance (scatter / n).
struct SampleMean {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  int count = 0;
};

/// At least two points, else std::invalid_argument.
[[nodiscard]] SampleMean sample_mean(const std::vector<Eigen::Vector2d>& sample);

/// A quantity that depends on two samples' means through these gradients.
[[nodiscard]] Estimate welch_estimate(double value, const Eigen::Vector2d& gradient_a,
                                      const SampleMean& a, const Eigen::Vector2d& gradient_b,
                                      const SampleMean& b);

}  // namespace trussmap
