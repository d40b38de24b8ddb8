// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Frames of a motion capture of the tracked body of PHIL's Turtlebot (phil.cpp has the columns).
#pragma once

#include "trussmap/recording.hpp"

#include <filesystem>
#include <vector>

namespace trussmap::datasets {

/// Poses of the robot up to a time, s, 0.1 s apart; `lost` counts frames without the robot, or
/// where it jumps. Throws InputError with file and line.
[[nodiscard]] std::vector<TruthRow> read_phil_frames(const std::filesystem::path& folder,
                                                     double until, int& lost);

}  // namespace trussmap::datasets
