// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of recordings as a problem has them: between two of its measurements.
#pragma once

#include "estimation/recording_problem.hpp"
#include "trussmap/held_out.hpp"

#include <vector>

namespace trussmap {

/// Between two measurements of the same session (sightings of the stops' references, or truth
/// rows).
struct LegSpan {
  int session = 0;
  TimeSpan time;
  std::size_t from = 0;  ///< measurement
  std::size_t to = 0;    ///< measurement
  bool held_out = false;
};

/// Legs of a problem, in order.
[[nodiscard]] std::vector<LegSpan> leg_spans(const std::vector<Recording>& recordings,
                                             const RecordingProblem& problem,
                                             const LegOptions& options = {});

}  // namespace trussmap
