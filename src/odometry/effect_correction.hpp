// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings freed from the effects that the model knows, before a map is built from them.
#pragma once

#include "trussmap/dead_reckoning.hpp"
#include "trussmap/model.hpp"

#include <vector>

namespace trussmap::odometry {

/// Each recording as corrected_recording.hpp makes it. Shapes that speak of heading, x or y see the
/// dead-reckoned path of the corrected recording itself, which two passes give. Throws
/// std::invalid_argument as corrected_recording does.
[[nodiscard]] std::vector<DrivenRecording> without_effects(
    const std::vector<DrivenRecording>& recordings, const Model& model);

}  // namespace trussmap::odometry
