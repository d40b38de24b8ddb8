// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/arrival_rise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap {

double rise_in_sds(const HeldOut& before, const HeldOut& after) {
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const LegPrediction& one : before.legs) {
    const auto other =
        std::find_if(after.legs.begin(), after.legs.end(),
                     [&one](const LegPrediction& leg) { return leg.leg == one.leg; });
    if (other == after.legs.end()) continue;
    const double rise = other->arrival_error.squaredNorm() - one.arrival_error.squaredNorm();
    n += 1.0;
    sum += rise;
    squares += rise * rise;
  }
  const double variance = (squares - sum * sum / n) / (n - 1.0);
  return n > 1.0 && variance > 0.0 ? sum / std::sqrt(n * variance)
                                   : std::numeric_limits<double>::infinity();
}

}  // namespace trussmap
