// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/arrival_rise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap::validation {

double sum_in_sds(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double one : values) {
    sum += one;
    squares += one * one;
  }
  const double variance = (squares - sum * sum / n) / (n - 1.0);
  return n > 1.0 && variance > 0.0 ? sum / std::sqrt(n * variance)
                                   : std::numeric_limits<double>::infinity();
}

double rise_in_sds(const HeldOut& before, const HeldOut& after) {
  std::vector<double> rises;
  for (const LegPrediction& one : before.legs) {
    const auto other =
        std::find_if(after.legs.begin(), after.legs.end(),
                     [&one](const LegPrediction& leg) { return leg.leg == one.leg; });
    if (other == after.legs.end()) continue;
    rises.push_back(other->arrival_error.squaredNorm() - one.arrival_error.squaredNorm());
  }
  return sum_in_sds(rises);
}

}  // namespace trussmap::validation
