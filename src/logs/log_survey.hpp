// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is in a log, as far as a first map.toml needs it.
#pragma once

#include "logs/wheel_topics.hpp"
#include "trussmap/log_files.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace trussmap::logs {

struct FrameFacts {
  std::string parent;
  std::string child;
  std::string topic;
  bool is_static = false;
  std::size_t samples = 0;
  bool moves = false;                                ///< in its parent
  bool turns = false;                                ///< in its parent
  Eigen::Matrix3d z_axes = Eigen::Matrix3d::Zero();  ///< sum of z z', its z axis in its parent
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();  ///< its rotation in its parent
  double translation_y = 0.0;                                ///< m, of the first sample
};

struct LogSurvey {
  std::vector<LogTopicFacts> topics;
  std::vector<FrameFacts> frames;
  WheelTopics wheels;  ///< with their constants
  bool table = false;
  std::string time_unit = {};  ///< of a table's times, where logs beside it tell; empty: a guess
  std::string cut_off;
  std::vector<LogCount> passed_over = {};

  /// How much of the frame's z axis stands up in `base`, 0 to 1 (root mean square), if the frames
  /// between them are turned as at the end.
  [[nodiscard]] double upright_share(const FrameFacts& frame, const std::string& base) const;
};

[[nodiscard]] LogSurvey survey_log(const std::filesystem::path& log,
                                   const GivenDefinitions& definitions);

/// Throws InputError where the log is damaged.
[[nodiscard]] LogInspection inspect_one_log(const std::filesystem::path& log,
                                            const GivenDefinitions& definitions);

/// Of a table whose rows are not in order of time, or stand twice: its fields as in that order.
void put_in_order(LogSurvey& survey, const std::filesystem::path& table);

/// A first map.toml of logs that are read as one, with the clock of each; `survey`: a file of
/// landmarks; empty: none.
[[nodiscard]] std::string guessed_joined_map(const std::vector<LogSurvey>& surveys,
                                             const std::vector<LogClockFacts>& clocks,
                                             const std::string& survey);

/// A first map.toml. `log`: its name, for the comments.
[[nodiscard]] std::string guessed_map(const LogSurvey& survey, const std::string& log);

/// "nav_msgs/Odometry" of "nav_msgs/msg/Odometry".
[[nodiscard]] std::string short_type(std::string_view type);

}  // namespace trussmap::logs
