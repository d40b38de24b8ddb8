// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Evidence (trussmap/evidence.hpp) of one effect, where score tests of a fit without it are there.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/evidence.hpp"

#include <vector>

namespace trussmap::criticism {

/// What the recordings show of an effect, along its place or its natural variable, with the curves
/// of these rivals (with coefficients). `tests` are of `fit`, which lacks the effect. `rows`: as
/// response_along's.
[[nodiscard]] EffectEvidence seen_effect(const EffectEstimate& estimate, std::vector<Effect> rivals,
                                         const fitting::FitState& fit, const ScoreTest& tests,
                                         const Eigen::VectorXd& rows = {});

/// One per finding.
[[nodiscard]] std::vector<FindingSize> sizes_of(const Diagnosis& diagnosis,
                                                const fitting::ShapeContext& context);

}  // namespace trussmap::criticism
