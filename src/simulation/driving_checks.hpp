// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a path can be laid by. Each throws std::invalid_argument and says what was expected.
#pragma once

#include "trussmap/simulation.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::simulation {

void check_style(const DrivingStyle& style);

/// As many orders as legs, or none.
void check_orders(const DrivingStyle& style, std::size_t legs);

/// Lengths above 0, columns as many as the drive has.
void check_wheels(const Robot& robot);

/// Landmarks of the mesh, two or more, successive ones at least 20 `standing` (m), 1 cm and twice
/// the turning radius (m) apart.
void check_walk(const Mesh& mesh, const std::vector<int>& walk, double standing,
                double turning_radius);

}  // namespace trussmap::simulation
