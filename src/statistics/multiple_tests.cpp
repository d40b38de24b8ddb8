// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <numeric>

namespace trussmap::statistics {

double bonferroni(double p_value, double tests) {
  return std::min(1.0, tests * p_value);
}

std::vector<double> holm(const std::vector<double>& p_values) {
  return holm(p_values, std::vector<int>(p_values.size(), 1), static_cast<double>(p_values.size()));
}

std::vector<double> holm(const std::vector<double>& p_values, const std::vector<int>& tests,
                         double all) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size(), 1.0);
  double remaining = all;
  double most = 0.0;
  for (const std::size_t k : order) {
    most = std::max(most, bonferroni(p_values[k], remaining));
    adjusted[k] = most;
    remaining -= tests[k];
  }
  return adjusted;
}

}  // namespace trussmap::statistics
