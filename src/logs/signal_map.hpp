// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tables of map.toml that are a field over time.
#pragma once

#include "logs/log_map.hpp"
#include "logs/toml_fields.hpp"
#include "logs/units.hpp"

#include <string>
#include <vector>

namespace trussmap::logs {

/// The unit under `key`, of one of these quantities. Throws InputError on another.
[[nodiscard]] Unit unit_of(TomlFields& table, const char* key, const char* otherwise,
                           const std::vector<Quantity>& allowed);

/// [wheels.NAME]: m, or rad of a steering.
[[nodiscard]] SignalMap wheel_of(const toml::table& node, const std::string& file,
                                 const std::string& name, bool steers);
/// [heading], rad.
[[nodiscard]] SignalMap heading_of(const toml::table& node, const std::string& file);
/// [yaw_rate], rad/s, or rad so far.
[[nodiscard]] SignalMap yaw_rate_of(const toml::table& node, const std::string& file);
/// Of [covariates]: a field's name alone, or a table.
[[nodiscard]] SignalMap covariate_of(const toml::node& node, const std::string& file,
                                     const std::string& name);

}  // namespace trussmap::logs
