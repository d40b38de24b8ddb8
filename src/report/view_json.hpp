// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// JSON of the workbench's page: what its parts have in common.
#pragma once

#include "plot/chart.hpp"
#include "trussmap/held_out.hpp"
#include "trussmap/model.hpp"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace trussmap::report {

/// Name, formula, channel and shapes; what causes it and what helps, where the catalogue knows.
[[nodiscard]] nlohmann::ordered_json effect_view(const Effect& effect);
[[nodiscard]] nlohmann::ordered_json chart_view(const plot::Chart& chart);
/// Root mean square of the held-out legs; null where there are none.
[[nodiscard]] nlohmann::ordered_json millimetres(const std::optional<HeldOutMetrics>& metrics);
/// Bytes that are no UTF-8 replaced.
[[nodiscard]] std::string safe_text(const nlohmann::ordered_json& json);

}  // namespace trussmap::report
