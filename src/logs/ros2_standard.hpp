// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The fields of standard ROS 2 messages, for bags that keep no definitions (those of sqlite3 before
// ROS 2 Iron): as in Humble. Source: the .msg files of the packages.
#pragma once

#include <string_view>

namespace trussmap::logs {

/// Of a type as "std_msgs/Header", without those of the types in it; no data() where there is none.
[[nodiscard]] std::string_view standard_ros2_definition(std::string_view type);

}  // namespace trussmap::logs
