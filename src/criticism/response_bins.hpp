// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bins of a variable over the rows in which the robot moves.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/evidence.hpp"

#include <string>
#include <vector>

namespace trussmap::criticism {

struct Bins {
  std::vector<ResponseBin> bins;  ///< without estimates
  std::vector<Shape> shapes;      ///< of each: 1 in the bin, else 0
};

/// Of a formula: equally many rows in each, one per value where there are few; of the heading,
/// twelve directions; of a distance from a place finer near it. None where the recordings lack a
/// variable, or it does not vary.
[[nodiscard]] Bins bins_of(const Shape& formula, const fitting::FitState& fit,
                           const ScoreTest& tests, bool from_place);

}  // namespace trussmap::criticism
