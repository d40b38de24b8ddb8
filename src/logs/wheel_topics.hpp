// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A bag's topics that tell what two wheels did, and the constants with which the robot's own
// odometry turns the one into the other.
//
//   way ahead = radius x mean turn of the wheels, turn = radius/wheelbase x difference of their
//   turns
#pragma once

#include "logs/joined_logs.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

struct LogSurvey;

struct WheelConstants {
  double radius = 0.0;     ///< m
  double wheelbase = 0.0;  ///< m
};

struct WheelTopics {
  std::string left;                 ///< path to a joint's angle; empty: none
  std::string right;                ///< the same
  std::string odometry;             ///< nav_msgs/Odometry of the wheels; empty: none
  std::vector<std::string> others;  ///< further ones
  std::optional<WheelConstants> constants;
};

/// By types and names.
[[nodiscard]] WheelTopics wheel_topics(const LogSurvey& survey);

/// By least squares over the whole log; none where odometry and joints do not say the same.
[[nodiscard]] std::optional<WheelConstants> wheel_constants(const JoinedLogs& log,
                                                            const WheelTopics& topics);

}  // namespace trussmap::logs
