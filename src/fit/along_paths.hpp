// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "fit/fit_state.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap::fitting {

/// With these landmarks, every pose on its session's path. One that is not among them lies where
/// these poses have seen it: a delay may bring back into the drive what it took out before.
[[nodiscard]] estimation::RecordingState along_paths(
    const estimation::RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
    const std::vector<SessionPath>& paths, const std::map<std::string, Vector2>& landmarks);

}  // namespace trussmap::fitting
