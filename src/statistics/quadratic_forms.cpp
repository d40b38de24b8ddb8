// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/quadratic_forms.hpp"

#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace trussmap::statistics {
namespace {

/// Derivatives of the form's cumulant generating function at z < 1/(2 max weight).
struct Cumulants {
  double K = 0.0;
  double first = 0.0;
  double second = 0.0;
};

Cumulants cumulants(double z, const std::vector<double>& weights) {
  Cumulants at;
  for (const double one : weights) {
    const double left = 1.0 - 2.0 * z * one;
    at.K -= 0.5 * std::log(left);
    at.first += one / left;
    at.second += 2.0 * one * one / (left * left);
  }
  return at;
}

/// Where the first derivative, which rises, is `value`.
double saddlepoint(double value, const std::vector<double>& weights, double most) {
  double low = -0.5 * static_cast<double>(weights.size()) / value;  // K' is below value there
  double high = 0.5 / most;                                         // K' is infinite there
  for (int round = 0; round < 200 && high - low > 1e-14 * (0.5 / most); ++round) {
    const double middle = 0.5 * (low + high);
    (cumulants(middle, weights).first < value ? low : high) = middle;
  }
  return low;
}

}  // namespace

double quadratic_form_p_value(double value, const std::vector<double>& weights) {
  std::vector<double> positive;
  std::copy_if(weights.begin(), weights.end(), std::back_inserter(positive),
               [](double one) { return one > 0.0; });
  if (positive.empty() || !(value > 0.0)) return 1.0;
  const Cumulants mean = cumulants(0.0, positive);
  constexpr double kNear = 1e-3;  // standard deviations, where the formula is 0/0
  if (std::abs(value - mean.first) < kNear * std::sqrt(mean.second)) {
    double third = 0.0;
    for (const double one : positive) third += 8.0 * one * one * one;
    return 0.5 - third / (6.0 * std::sqrt(2.0 * std::numbers::pi) * std::pow(mean.second, 1.5));
  }
  const double z =
      saddlepoint(value, positive, *std::max_element(positive.begin(), positive.end()));
  const Cumulants at = cumulants(z, positive);
  const double w = std::copysign(std::sqrt(std::max(0.0, 2.0 * (z * value - at.K))), z);
  const double v = z * std::sqrt(at.second);
  return std::clamp(0.5 * std::erfc((w + std::log(v / w) / w) / std::numbers::sqrt2), 0.0, 1.0);
}

double largest_square_p_value(double value, const std::vector<double>& cosines) {
  double length = 0.0;
  for (const double one : cosines) length += std::acos(std::clamp(one, -1.0, 1.0));
  return std::min(1.0, chi2_p_value_real(value, 1.0) +
                           length / std::numbers::pi * std::exp(-0.5 * std::max(0.0, value)));
}

}  // namespace trussmap::statistics
