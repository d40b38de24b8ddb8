// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Weights of measurements that may be wrong, whatever is adjusted: sightings and fixes of
// recordings, loop closures of pose graphs.
//
//   r^2    squared whitened error of a measurement
//   c^2    the largest r^2 that a right one should have: `gate`
//   w      its weight, 0 ... 1
//   mu     how far the cost is bent from a plain square (0) to min(r^2, c^2) (infinity)
//
// Graduated non-convexity: Yang, Antonante, Tzoumas & Carlone, "Graduated non-convexity for robust
// spatial perception", 2020. Who adjusts says how measurements are weighed and how it descends.
#pragma once

#include <limits>

namespace trussmap::estimation {

/// Geman and McClure: (c^2/(r^2 + c^2))^2.
[[nodiscard]] double soft_weight(double squared_error, double gate);

/// Of the truncated square bent by mu (Yang et al., eq. 14).
[[nodiscard]] double gnc_weight(double squared_error, double gate, double mu);

/// The mu to begin with where this is the largest r^2, above c^2/2 (Yang et al., remark 5): no
/// error is out yet.
[[nodiscard]] double first_bend(double largest_squared_error, double gate);

struct Bending {
  double first = 0.0;  ///< mu
  double last = std::numeric_limits<double>::infinity();
  int most_rounds = std::numeric_limits<int>::max();
};

/// Rounds of weights and descents, the cost bent a little more in each. `weigh(mu)` says whether to
/// go on after this round's `descend()`; there are two at least.
template <typename Weigh, typename Descend>
void bend(const Bending& how, Weigh weigh, Descend descend) {
  constexpr double kFaster = 1.4;  // Yang et al.: small enough that the minimum is followed
  double mu = how.first;
  for (int round = 0; round < how.most_rounds && mu < how.last; ++round, mu *= kFaster) {
    const bool further = weigh(mu);
    descend();
    if (!further && round > 0) return;
  }
}

/// The fit of what is kept may find room for what was out, and the reverse: rounds until `again`,
/// which is told how many there were, says that nothing changes.
template <typename Again>
void reconsider(Again again) {
  constexpr int kMostRounds = 5;  // they may go round in a circle
  for (int round = 0; round < kMostRounds; ++round) {
    if (!again(round)) return;
  }
}

}  // namespace trussmap::estimation
