// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the workbench's page shows of legs, all or some that were chosen: how far off those held out
// end, the map, time.
#pragma once

#include "trussmap/workbench.hpp"

#include <cstddef>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::report {

/// Of legs by their numbers, ascending; of all without any given. `first_rms`: how far off held-out
/// legs end at the first step, m, which scales the map's colours.
[[nodiscard]] nlohmann::ordered_json views_json(
    const TriedModel& now, const std::optional<std::vector<std::size_t>>& chosen, double first_rms);

}  // namespace trussmap::report
