// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables without a header whose rows are messages as `ros2 topic echo --csv` writes them: all
// fields of a standard message, one after the other.
//
//   1748457053,946277034,odom,base_link,0.1,0.2,...   nav_msgs/Odometry: 89 fields
//   columns: header.stamp.sec, header.stamp.nanosec, header.frame_id, child_frame_id, ...
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

/// Names of the columns by the fields of the standard message that all rows are like: as many
/// fields, numbers and texts where it has them, nanoseconds below 1e9, quaternions of length 1 or
/// 0. Empty where they are like none. Precondition: rows of equal length, one or more.
[[nodiscard]] std::vector<std::string> echoed_columns(
    const std::vector<std::vector<std::string>>& rows);

}  // namespace trussmap::logs
