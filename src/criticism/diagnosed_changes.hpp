// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients that change, beside what a diagnosis says is missing and the noise that it
// estimated.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <optional>

namespace trussmap::criticism {

/// Of the fit with all that is missing, which explains the recordings on average at least. What is
/// missing and goes with time may be such a change: then that of the fit without it is told. Noise
/// that was estimated may hold a part of a change: whether there is one is asked beside it, what it
/// is beside the noise that the model states.
/// A change in a model that lacks nothing makes the verdict an unexplained misfit. `stated`: the
/// fit by the model's noise; `about`: the tests of the fit with what is missing, or of `fit`.
void tell_changes(const ModelFit& stated, const ModelFit& fit, const std::optional<ModelFit>& with,
                  const ScoreTest& about, Diagnosis& result);

}  // namespace trussmap::criticism
