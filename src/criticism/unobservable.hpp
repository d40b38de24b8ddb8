// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects of which a test could see nothing, and why.
#pragma once

#include "criticism/tested_candidate.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/diagnose.hpp"

namespace trussmap::criticism {

/// Not seen, but would be where the model explained the rest.
[[nodiscard]] bool hidden_by_misfit(const Tested& one);

[[nodiscard]] Unobservable why_unobservable(const Tested& one,
                                            const estimation::RecordingProblem& problem);

}  // namespace trussmap::criticism
