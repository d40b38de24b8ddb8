// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Estimated noise as a table and as JSON.
#pragma once

#include "trussmap/noise_fit.hpp"

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// A line of what was found and, where anything differs from what is stated, a table.
void print_noise(const FittedNoise& noise);

/// What dead reckoning owes to each source, after an empty line; nothing where there is one alone.
void print_budget(const std::vector<NoiseBudget>& budget);

[[nodiscard]] nlohmann::ordered_json budget_json(const std::vector<NoiseBudget>& budget);
[[nodiscard]] nlohmann::ordered_json noise_json(const FittedNoise& noise);

}  // namespace trussmap::app
