// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A drive's turning, and of two wheels their ratio, by what a compass, a gyro or truth says of its
// turns: a straight line through a few hundred stretches, by least absolute residuals.
#pragma once

#include "calibration/gross_starts.hpp"

#include <optional>

namespace trussmap::calibration {

/// Where other constants are as near as that to the stated ones, those are a start themselves.
inline constexpr double kNearTurn = 0.1;
inline constexpr double kNearRatio = 0.05;

/// None where nothing of the kind is there, or the stated constants are as good.
[[nodiscard]] std::optional<GrossStart> start_by_turns(
    const std::vector<DrivenRecording>& recordings, const Robot& robot);

}  // namespace trussmap::calibration
