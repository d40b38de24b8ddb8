// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is in a log, as far as a first map.toml needs it.
#pragma once

#include "io/logs/wheel_topics.hpp"
#include "trussmap/log_files.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace trussmap {

struct FrameFacts {
  std::string parent;
  std::string child;
  bool is_static = false;
  std::size_t samples = 0;
  bool moves = false;          ///< in its parent
  double upright_z = 0.0;      ///< mean share of the child's z axis that stands up in its parent
  double translation_y = 0.0;  ///< m, of the first sample
};

struct LogSurvey {
  std::vector<LogTopicFacts> topics;
  std::vector<FrameFacts> frames;
  WheelTopics wheels;  ///< with their constants
  bool table = false;
  std::string cut_off;

  [[nodiscard]] const LogTopicFacts* find_type(std::string_view type) const;
};

[[nodiscard]] LogSurvey survey_log(const std::filesystem::path& log);

/// A first map.toml. `log`: its name, for the comments.
[[nodiscard]] std::string guessed_map(const LogSurvey& survey, const std::string& log);

/// "nav_msgs/Odometry" of "nav_msgs/msg/Odometry".
[[nodiscard]] std::string short_type(std::string_view type);

}  // namespace trussmap
