// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Trees of a graph without times, brought into the drive that its odometry was summed up from.
//
//   rows of the drive   . . . . . . . . . . . . . . . . . .     f ahead, a turned, each
//   poses               0               1         3             edge: x += f cos h, y += f sin h,
//                                                                     h += a, from (0, 0, 0)
//
// An edge is found where rows that follow the last one's sum up to it, to the digits of the text.
// Rows in between, which no edge has, can only be those of a truck that stands still.
#pragma once

#include "trussmap/recording.hpp"

#include <filesystem>
#include <vector>

namespace trussmap::datasets {

/// How the body moves in a row.
struct BodyStep {
  double ahead = 0.0;   ///< m
  double turned = 0.0;  ///< rad
};

/// Takes the graph's sightings into the recording, whose drive the steps are; returns how many
/// poses were found. Throws InputError where one is not.
[[nodiscard]] int take_trees(const std::filesystem::path& graph, const std::vector<BodyStep>& steps,
                             Recording& recording);

}  // namespace trussmap::datasets
