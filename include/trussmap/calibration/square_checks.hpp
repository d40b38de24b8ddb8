// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether runs round a square can be what they are said to be, and what one direction alone hides.
//
// Four coordinates determine two unknowns, so two combinations of them are left to contradict.
// Exchanged labels cw/ccw do so in a way of their own: alpha from x and alpha from y get opposite
// signs, and so do the betas. An axis y that points to the right does the same.
#pragma once

#include "trussmap/calibration/umbmark.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct SquareConsistency {
  double residual = 0.0;  ///< root mean square of what the exact solution leaves of the centres, m
  double residual_exchanged = 0.0;  ///< the same with cw and ccw exchanged, m
  /// Probability of a contradiction as large by the scatter of the runs alone; NaN without scatter.
  double p_value = 0.0;
};

[[nodiscard]] SquareConsistency square_consistency(const SquareClusters& clusters,
                                                   const SquareSetup& setup);

/// Doubts, a sentence each, that a person can act on: exchanged labels, a contradiction, runs all
/// equal, millimetres. `errors`: those in the clusters.
[[nodiscard]] std::vector<std::string> square_doubts(const SquareClusters& clusters,
                                                     const SquareSetup& setup);

/// Borenstein & Feng (1996), Fig. 4: a robot with both errors, its wheelbase alone tuned until the
/// square closes in one direction.
struct OneWayTuning {
  double wheelbase_ratio = 1.0;  ///< tuned over nominal wheelbase
  double error_before = 0.0;     ///< m, in the direction driven
  double error_same_way = 0.0;   ///< m, after tuning, in the direction driven
  double error_other_way = 0.0;  ///< m, after tuning, in the other
};

[[nodiscard]] OneWayTuning tune_one_way(const GeometryErrors& errors, const SquareSetup& setup,
                                        Direction driven);

}  // namespace trussmap
