// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags of ROS 1 (.bag, format 2.0), whose topics are told by names.
#pragma once

#include "logs/bag_topics.hpp"

#include <filesystem>
#include <string>

namespace trussmap::logs {

/// Whether the first bytes are those of a bag of ROS 1, of whatever version.
[[nodiscard]] bool is_ros1_bag(const std::filesystem::path& file);

/// What it lacks at its end; empty: nothing. Throws InputError with `shown` for the name of the
/// file.
[[nodiscard]] std::string read_ros1_bag(const std::filesystem::path& file, const std::string& shown,
                                        BagTopics& topics);

}  // namespace trussmap::logs
