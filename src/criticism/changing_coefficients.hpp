// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is an effect's coefficient the same all the time? Asked of a fit that has it so, by what parts of
// the driving say of it (coefficient_course.hpp: G, s).
//
//   step at k   z_k^2 = (sum over j >= k of s_j)^2 / (phi sum of G over both >= k); the largest of
//               all, its tail by Davies' bound
//   walk        d_(k+1) - d_k ~ N(0, tau^2 time between), score of tau^2: s'Ws, a quadratic form in
//               normal errors, W_jk = min(time_j, time_k)
//
// Both are about the constant, which the fit has. phi is chi^2/dof of what the change leaves, at
// least 1. What happened is the likelier of the two, and no step where that leaves a change. The
// course is the mean of what all moments and sizes have, each by its likelihood.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"

#include <vector>

namespace trussmap::criticism {

/// p below which a change is told: it is asked beside all else.
inline constexpr double kChangeLevel = 0.01;

/// Those of the fit's effects whose coefficients change, the chance of naming any where none does
/// at most `level`; surest first. Effects with coefficients that differ by session are passed over.
/// `tests`: of this fit.
[[nodiscard]] std::vector<ChangingCoefficient> changing_coefficients(const fitting::FitState& fit,
                                                                     const ScoreTest& tests,
                                                                     double level = kChangeLevel);

}  // namespace trussmap::criticism
