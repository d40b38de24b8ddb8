// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A built map as JSON, and what was written of it.
#pragma once

#include "page_runtime.hpp"
#include "trussmap/build_map.hpp"

#include <string>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// Every figure; `method` as the command names it.
[[nodiscard]] nlohmann::ordered_json build_json(const BuiltMap& built, const std::string& method);

/// Per landmark x, y and, where known, its covariance.
[[nodiscard]] nlohmann::ordered_json positions_json(const LandmarkGraph& map);

void print_written(const Files& files);

}  // namespace trussmap::app
