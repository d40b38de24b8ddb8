// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows of a drive out of a log: when they begin and end, and what each wheel travelled in them.
//
// Rows are as long as the slowest wheel's messages are apart, or as [rows] says; the travels of all
// others are interpolated sums.
#pragma once

#include "logs/gathered_log.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::logs {

struct WheelRows {
  std::vector<std::int64_t> bounds;  ///< ns; row k is from bounds[k] to bounds[k + 1]
  std::vector<double> left;          ///< m; empty of a drive with other columns
  std::vector<double> right;
  std::vector<Covariate> columns;  ///< of such a drive: m, rad
  std::size_t unordered = 0;
  std::size_t repeated = 0;
  std::vector<std::string> warnings;
};

/// Throws InputError where wheels are missing, or share no stretch of two rows.
[[nodiscard]] WheelRows wheel_rows(const LogMap& map, GatheredLog& log);

/// The way of two wheels that would drive as [odometry] says, in rows of these bounds, which lie
/// within its times where they are added. Precondition: the map has [odometry].
struct OdometryRows {
  std::vector<std::int64_t> bounds;  ///< ns, of those given
  std::vector<double> left;          ///< m
  std::vector<double> right;
};
[[nodiscard]] OdometryRows odometry_rows(const LogMap& map, const GatheredLog& log,
                                         const std::vector<std::int64_t>& bounds);

/// Poses along /tf:parent.child, in order of time, `clock` (s) added to it. Throws InputError where
/// the frames are not joined, or do not move.
[[nodiscard]] std::vector<TimedFieldPose> poses_along(const std::string& path,
                                                      const FrameTree& frames, const LogMap& map,
                                                      std::size_t line, double clock);

}  // namespace trussmap::logs
