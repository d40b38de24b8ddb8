// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Covariates that vary slowly over a recording, as a temperature does: what goes with one of them
// looks like what goes with time or distance.
#pragma once

#include "trussmap/robot.hpp"

#include <string>
#include <vector>

namespace trussmap::drive {

/// nullptr where the drive has none of this name.
[[nodiscard]] const Covariate* find_covariate(const MotionRows& drive, const std::string& name);

/// Names of the covariates that all recordings have and that vary between tenths of a recording
/// rather than within them: at most a tenth of their variance is within.
[[nodiscard]] std::vector<std::string> slow_covariates(
    const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap::drive
