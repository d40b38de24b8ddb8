// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a path can be laid by. Each throws std::invalid_argument and says what was expected.
#pragma once

#include "trussmap/simulation.hpp"

#include <vector>

namespace trussmap {

void check_style(const DrivingStyle& style);

/// Landmarks of the mesh, two or more, successive ones at least 20 `standing` (m) and 1 cm apart.
void check_walk(const Mesh& mesh, const std::vector<int>& walk, double standing);

}  // namespace trussmap
