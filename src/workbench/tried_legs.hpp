// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of a tried model: where and when they were driven, and which rows of its fit are theirs.
#pragma once

#include "estimation/recording_system.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/workbench.hpp"
#include "validation/leg_spans.hpp"

#include <vector>

namespace trussmap::workbench {

/// All legs, by their numbers. `recordings` as they were before delays were taken out; the fit has
/// paths.
[[nodiscard]] std::vector<TriedLeg> tried_legs(const std::vector<DrivenRecording>& recordings,
                                               const fitting::FitState& fit,
                                               const LegOptions& options);

/// Of the system's rows 1 for what was driven and sighted on those legs of a fit (leg_spans) that
/// have one of these numbers, 0 for all else; empty (all rows) without numbers.
[[nodiscard]] Eigen::VectorXd rows_of_legs(const std::vector<std::size_t>& numbers,
                                           const std::vector<validation::LegSpan>& legs,
                                           const fitting::FitState& fit,
                                           const estimation::RecordingSystem& system);

}  // namespace trussmap::workbench
