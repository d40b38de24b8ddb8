// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model fitted to all legs but some: those that are held out.
#pragma once

#include "fit/fit_state.hpp"
#include "validation/leg_spans.hpp"

#include <vector>

namespace trussmap::validation {

/// Per session, in the times of the fit's recordings: these spans and, between them, what is not
/// connected to the map without them.
[[nodiscard]] std::vector<std::vector<TimeSpan>> with_unconnected(
    std::vector<std::vector<TimeSpan>> spans, const fitting::FitState& fit);

/// Spans between what was sighted or known, as it was recorded before the fit's delays were taken
/// out.
[[nodiscard]] std::vector<std::vector<TimeSpan>> recorded_spans(
    std::vector<std::vector<TimeSpan>> spans, const std::vector<DrivenRecording>& recordings,
    const fitting::FitState& fit);

/// Starts from `fit`, of all legs of these recordings. What is driven between held-out legs and is
/// not connected to the map without them is left out as well. Throws like fit_recordings.
[[nodiscard]] fitting::FitState fit_without(const std::vector<LegSpan>& legs,
                                            const std::vector<DrivenRecording>& recordings,
                                            const fitting::FitState& fit,
                                            const fitting::FitterOptions& options);

}  // namespace trussmap::validation
