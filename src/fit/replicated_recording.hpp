// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings as a fitted model lets one expect them: the same drives, landmarks, instants and
// covariates, with errors drawn anew from its noise (a parametric bootstrap; Efron & Tibshirani
// 1993, ch. 6). What is said of the recording has to hold of these, where the truth is known.
//
//   fit --> rows, readings, views without error --> + white noise, processes --> recording
//
// Wheels: rows are changed until, under the effects, they lead exactly from one fitted pose to the
// next (fitted_path.hpp). A robot that stands on a landmark misses it by the noise of `sighting`:
// its poses move, and the wheels with them.
#pragma once

#include "fit/fit_state.hpp"

#include <cstdint>

namespace trussmap::fitting {

/// `recordings` are those that were fitted. What the fit left out is drawn like all else. Throws
/// std::invalid_argument where a process acts on a channel that no recording can hold (creep,
/// lever, lever_left, delay, truth_heading). The same seed gives the same.
[[nodiscard]] std::vector<DrivenRecording> replicated(
    const std::vector<DrivenRecording>& recordings, const FitState& fit, std::uint64_t seed);

}  // namespace trussmap::fitting
