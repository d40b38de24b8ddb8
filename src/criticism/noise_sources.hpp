// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is each source of noise as large as stated, and normal?
#pragma once

#include "criticism/score_test.hpp"
#include "estimation/data_snooping.hpp"
#include "trussmap/compare.hpp"

#include <vector>

namespace trussmap::criticism {

/// Sources in the order in which they first appear; those that are hardly checked are left out.
[[nodiscard]] std::vector<SourceCalibration> calibrate_sources(const fitting::FitState& fit,
                                                               const ScoreTest& tests);

/// Standardised residuals of data_snooping.hpp, source by source in the same order.
[[nodiscard]] std::vector<SourceResiduals> residuals_by_source(
    const estimation::RecordingProblem& problem,
    const std::vector<estimation::CheckedMeasurement>& checked);

}  // namespace trussmap::criticism
