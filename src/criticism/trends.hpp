// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Trends of a fit's residuals: each kind of error against every variable, as score tests.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/compare.hpp"

#include <vector>

namespace trussmap::criticism {

/// Variables that trends are sought against: the built-in ones that vary, and every covariate.
/// Strongest first; what these recordings cannot show is left out.
[[nodiscard]] std::vector<Trend> find_trends(const fitting::FitState& fit, const ScoreTest& tests);

}  // namespace trussmap::criticism
