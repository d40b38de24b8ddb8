// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where recordings let a drive be planned: landmarks that the robot stood on, routes that it drove
// straight, speeds that it drove at, sensors that it has.
#pragma once

#include "planning/plan_world.hpp"

#include <string>
#include <vector>

namespace trussmap::planning {

/// `variables`: what a drive should vary, loads among them, if the driver sets these (columns of
/// loads, and switches of two values). `start`: empty: where the last recording ended.
/// `max_speed` in m/s; 0: as fast as was driven. At most some thirty landmarks near the start.
/// Throws std::invalid_argument where there is no such start, SolveError where there are no routes.
[[nodiscard]] PlanWorld recorded_world(const fitting::FitState& fit,
                                       const std::vector<std::string>& variables,
                                       const std::string& start, double max_speed);

}  // namespace trussmap::planning
