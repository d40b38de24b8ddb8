// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags and logs of others: MCAP, rosbag2, WPILib, Road Runner, any table. Part of trussmap::logs.
//
//   log + map.toml --read_log_recording--> recording + model
//   log ------------inspect_log----------> what is in it, and a first map.toml
//
// docs/logs.md has the formats and the keys of map.toml.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace trussmap {

// ----------------------------------------
// In.

/// Whether the path is a log that can be read: an .mcap, a .db3 or a rosbag2's folder, a .wpilog, a
/// Road Runner .log, or a table (.csv, .tsv, .txt, also with .xz).
[[nodiscard]] bool is_log(const std::filesystem::path& path);

/// So many of something, for a list.
struct LogCount {
  std::size_t number = 0;
  std::string what;
};

struct LogRecording {
  Recording recording;
  Model model;                        ///< the map's [robot] and [noise]
  std::string epoch;                  ///< what t = 0 is
  std::vector<LogCount> counts;       ///< what came of the log, and what was left out
  std::vector<std::string> warnings;  ///< what is suspicious
};

/// Reads a log as its map.toml says. Throws InputError: the map's line where it is wrong or asks
/// for what the log does not have; the log's offset where it is damaged.
[[nodiscard]] LogRecording read_log_recording(const std::filesystem::path& log,
                                              const std::filesystem::path& map);

/// A field of a log's topic, or a column of a table.
struct LogFieldFacts {
  std::string path;        ///< as map.toml names it
  std::size_t values = 0;  ///< messages that have it
  bool is_text = false;
  double least = kAbsent;  ///< of numbers
  double largest = kAbsent;
  double first = kAbsent;
  double last = kAbsent;
  std::string example;        ///< of texts, the first that is not empty
  std::size_t different = 0;  ///< values that differ from the one before
  double total_step = 0.0;    ///< sum of the sizes of all steps from one value to the next
  std::size_t decreases = 0;  ///< values that are smaller than the one before
  bool is_whole = true;       ///< only whole numbers
};

struct LogTopicFacts {
  std::string name;
  std::string type;
  std::string unread;  ///< why its fields cannot be read; empty: they can
  std::uint64_t messages = 0;
  double first = kAbsent;  ///< s, in the log's own time
  double last = kAbsent;   ///< s
  double step = kAbsent;   ///< s between messages, median of the first thousands
  std::vector<LogFieldFacts> fields;
};

/// A transform of /tf or /tf_static.
struct LogFrameFacts {
  std::string parent;
  std::string child;
  bool is_static = false;
  std::size_t samples = 0;
};

struct LogInspection {
  std::vector<LogTopicFacts> topics;
  std::vector<LogFrameFacts> frames;
  std::string cut_off;  ///< where the log ends too soon; empty: it is whole
  std::string map;      ///< a first map.toml, whose guesses are its comments
};

/// Throws InputError where the log is damaged.
[[nodiscard]] LogInspection inspect_log(const std::filesystem::path& log);

}  // namespace trussmap
