// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/welch.hpp"

#include "statistics/distributions.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap {

Interval confidence_interval(const Estimate& estimate, double confidence) {
  if (estimate.dof <= 0.0) return {estimate.value, estimate.value};
  const double reach =
      student_quantile(0.5 + 0.5 * confidence, estimate.dof) * estimate.standard_error;
  return {estimate.value - reach, estimate.value + reach};
}

SampleMean sample_mean(const std::vector<Eigen::Vector2d>& sample) {
  if (sample.size() < 2) throw std::invalid_argument("a scatter takes two runs or more");
  SampleMean result;
  const auto n = static_cast<double>(sample.size());
  result.count = static_cast<int>(sample.size());
  for (const Eigen::Vector2d& point : sample) result.mean += point / n;
  for (const Eigen::Vector2d& point : sample) {
    const Eigen::Vector2d off = point - result.mean;
    result.covariance += off * off.transpose() / (n * (n - 1.0));
  }
  return result;
}

Estimate welch_estimate(double value, const Eigen::Vector2d& gradient_a, const SampleMean& a,
                        const Eigen::Vector2d& gradient_b, const SampleMean& b) {
  const double va = gradient_a.dot(a.covariance * gradient_a);
  const double vb = gradient_b.dot(b.covariance * gradient_b);
  const double sum = va + vb;
  if (!(sum > 0.0)) return {value, 0.0, 0.0};
  const double dof = sum * sum / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
  return {value, std::sqrt(sum), dof};
}

}  // namespace trussmap
