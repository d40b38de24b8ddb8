// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings one after the other on one axis of time.
#pragma once

#include "trussmap/robot.hpp"

#include <vector>

namespace trussmap::drive {

/// Per recording what to add to its times, s: the first begins at 0, each where the one before
/// ends.
[[nodiscard]] std::vector<double> elapsed_shifts(const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap::drive
