// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags that commands write: their options, and what is said of them.
#pragma once

#include "command_line.hpp"
#include "trussmap/log_files.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace trussmap::app {

/// --epoch, of which `note` says where it counts.
void add_epoch(const Command& command, std::optional<double>& epoch, const std::string& note);

/// BagOptions::epoch of that. Throws UsageError where it is none of ROS.
[[nodiscard]] std::optional<std::int64_t> epoch_of(const std::optional<double>& seconds);

/// Messages per topic, what was left out, where t = 0 is unless at 0.
void print_bag(const Bag& bag);

/// Where t = 0 is, unless at 0.
void print_epoch(std::int64_t epoch);

}  // namespace trussmap::app
