// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tables of map.toml that are times, and poses or velocities in several fields.
//
//   [time]      field, unit, fraction, fraction_unit, clock; or several [[time]], each with a file
//   [odometry]  twist | pose | x, y and heading or quaternion | speed and turn_rate
//   [truth]     pose | x, y and heading or quaternion
#pragma once

#include "logs/log_map.hpp"
#include "logs/toml_fields.hpp"

#include <string>
#include <vector>

namespace trussmap::logs {

/// [time] or [[time]]. Throws InputError where two are of the same file.
[[nodiscard]] std::vector<TimeMap> times_of(const toml::node& node, const std::string& file);
[[nodiscard]] OdometryMap odometry_of(const toml::table& node, const std::string& file);
[[nodiscard]] TruthMap truth_of(const toml::table& node, const std::string& file);
/// Paths under `quaternion`: four, two, or none where there is no such key.
[[nodiscard]] std::vector<std::string> quaternion_of(TomlFields& table);

}  // namespace trussmap::logs
