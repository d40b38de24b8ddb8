// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is built of recordings without landmarks, their paths, as JSON.
#pragma once

#include "trussmap/build_map.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// Figures of each path, and every fix and loop that was left out.
[[nodiscard]] nlohmann::ordered_json paths_json(const std::vector<BuiltPath>& paths);

}  // namespace trussmap::app
