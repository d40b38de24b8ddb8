// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fields over the floor, beside what a diagnosis says is missing and the noise that it estimated.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <optional>
#include <vector>

namespace trussmap::criticism {

/// Of the fit with all that is missing but for what goes with the place alone, which such a field
/// may be. Noise that was estimated may hold a part of a field: whether there is one is asked
/// beside it, what it is beside the noise that the model states (`stated`: the fit by it). A field
/// that is no patch makes the verdict of a model that lacks nothing an unexplained misfit. `about`:
/// the tests of the fit with what is missing, or of `fit`.
void tell_places(const std::vector<DrivenRecording>& recordings, const ModelFit& stated,
                 const ModelFit& fit, const std::optional<ModelFit>& with, const ScoreTest& about,
                 Diagnosis& result);

}  // namespace trussmap::criticism
