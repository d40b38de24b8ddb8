// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Estimated noise as JSON.
#pragma once

#include "trussmap/noise_fit.hpp"

#include <nlohmann/json.hpp>

namespace trussmap::app {

[[nodiscard]] nlohmann::ordered_json budget_json(const std::vector<NoiseBudget>& budget);
[[nodiscard]] nlohmann::ordered_json noise_json(const FittedNoise& noise);

}  // namespace trussmap::app
