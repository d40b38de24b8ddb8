// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/welch.hpp"

#include "statistics/distributions.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace trussmap {
namespace {

/// By the two parts of its variance.
Estimate of_parts(double value, double va, double dof_a, double vb, double dof_b) {
  const double sum = va + vb;
  if (!(sum > 0.0)) return {value, 0.0, 0.0};
  const double shared = (va > 0.0 ? va * va / dof_a : 0.0) + (vb > 0.0 ? vb * vb / dof_b : 0.0);
  return {value, std::sqrt(sum), sum * sum / shared};
}

}  // namespace

Interval confidence_interval(const Estimate& estimate, double confidence) {
  if (estimate.dof <= 0.0) return {estimate.value, estimate.value};
  const double reach =
      statistics::student_quantile(0.5 + 0.5 * confidence, estimate.dof) * estimate.standard_error;
  return {estimate.value - reach, estimate.value + reach};
}

}  // namespace trussmap

namespace trussmap::calibration {

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
  return of_parts(value, va, a.count - 1, vb, b.count - 1);
}

Estimate also_by(const Estimate& quantity, double slope, const Estimate& other) {
  return of_parts(quantity.value, std::pow(quantity.standard_error, 2), quantity.dof,
                  std::pow(slope * other.standard_error, 2), other.dof);
}

Estimate mean_of(const std::vector<double>& sample) {
  if (sample.size() < 2) throw std::invalid_argument("a scatter takes two runs or more");
  const auto n = static_cast<double>(sample.size());
  double mean = 0.0;
  for (const double one : sample) mean += one / n;
  double squares = 0.0;
  for (const double one : sample) squares += (one - mean) * (one - mean);
  return of_parts(mean, squares / (n * (n - 1.0)), n - 1.0, 0.0, 0.0);
}

Estimate sum_of(const Estimate& a, const Estimate& b) {
  return of_parts(a.value + b.value, std::pow(a.standard_error, 2), a.dof,
                  std::pow(b.standard_error, 2), b.dof);
}

double two_sided_p(const Estimate& estimate) {
  if (estimate.dof <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * statistics::student_p_value(std::abs(estimate.value) / estimate.standard_error,
                                           estimate.dof);
}

}  // namespace trussmap::calibration
