// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of recordings as a problem has them: between two of its measurements. They are numbered
// through all that was recorded, whatever of it a fit leaves out.
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/held_out.hpp"

#include <vector>

namespace trussmap::validation {

/// Between two measurements of the same session (sightings of the stops' references, or truth
/// rows).
struct LegSpan {
  std::size_t number = 0;
  int session = 0;
  TimeSpan time;
  std::size_t from = 0;  ///< measurement
  std::size_t to = 0;    ///< measurement
  bool held_out = false;
};

/// Whether a part of it is in times that are not to be used, per session; empty: there are none.
[[nodiscard]] bool is_excluded(const LegSpan& leg,
                               const std::vector<std::vector<TimeSpan>>& excluded);

/// Legs of a problem that leaves nothing out, in order.
[[nodiscard]] std::vector<LegSpan> leg_spans(const std::vector<DrivenRecording>& recordings,
                                             const estimation::RecordingProblem& problem,
                                             const LegOptions& options = {});

/// Legs of all that was recorded that the fit has, between measurements of its problem.
[[nodiscard]] std::vector<LegSpan> leg_spans(const fitting::FitState& fit,
                                             const LegOptions& options = {});

}  // namespace trussmap::validation
