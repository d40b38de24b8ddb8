// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Logs of messages, read once from begin to end in bounded memory: what bags, team logs and tables
// have in common.
//
//   topic     a name, a type, messages over time      /odom, nav_msgs/msg/Odometry
//   message   when it was recorded, and its fields    field_tree.hpp
//
// A reader meets topics as they come, asks of each whether it is wanted, and decodes the messages
// of those that are; of the others it counts messages alone. Messages come in the order of the
// file, which need not be that of time.
//
// A file that is damaged (a checksum that is wrong, a size beyond the file's end in the middle of
// it) throws InputError, "FILE: at byte N: what is wrong, what was expected". One that is cut off,
// as by a power cut, is read up to there: `cut_off` says so.
#pragma once

#include "logs/field_tree.hpp"
#include "logs/message_definitions.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace trussmap::logs {

struct LogTopic {
  std::string name;      ///< empty of a table, which has but one
  std::string type;      ///< as the log has it: nav_msgs/msg/Odometry, double[], struct:Pose2d
  std::string encoding;  ///< cdr, ros1, wpilog, road runner, csv, mat
  std::string unread;    ///< why its messages cannot be read ("protobuf"); empty: they can
  /// Fields are named by the columns of a table, which may have any characters in them.
  bool table = false;
  std::uint64_t messages = 0;  ///< so far
  std::string file = {};       ///< of several logs read as one (joined_logs.hpp): which
  std::size_t input = 0;       ///< the same, by its number
};

struct LogMessage {
  const LogTopic& topic;
  std::size_t number = 0;         ///< of the topic, in the order of their first appearance
  bool has_time = true;           ///< false in a log that keeps none beside the fields
  std::int64_t log_time = 0;      ///< ns since the log's own epoch (Unix, of bags): recorded
  std::int64_t publish_time = 0;  ///< ns: sent; log_time where the log does not know
  FieldRef fields;                ///< valid until the visit returns
  std::size_t line = 0;           ///< of a table: where the row begins
  std::uint64_t row = 0;          ///< of a table: the same for rows with the same text alone
};

struct LogVisit {
  /// Asked once a topic, before its first message, and again where its type changes.
  std::function<bool(const LogTopic&)> wanted;
  std::function<void(const LogMessage&)> message;
  /// Of lists of plain numbers: how many elements are kept; of lists of groups and texts all.
  std::size_t elements = 4096;
  /// Of types that a bag of ROS 2 does not define itself; nothing: none.
  const MessageDefinitions* definitions = nullptr;
};

/// So many records of a kind that no topic has.
struct PassedOver {
  std::uint64_t number = 0;
  std::string what;  ///< in the plural: "records of entries that were not started"
};

struct LogEnd {
  std::vector<LogTopic> topics;  ///< with all their messages counted
  std::string cut_off;           ///< "at byte 123: ends in the middle of a chunk"; empty: whole
  std::vector<PassedOver> passed_over = {};
};

/// Bytes that one chunk, record or message may have once decompressed: a size in a file is an
/// attacker's.
inline constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20U;

// A file per format. `is_` looks at the first bytes, or at the name of a folder's files.

[[nodiscard]] bool is_mcap(const std::filesystem::path& file);
[[nodiscard]] LogEnd read_mcap(const std::filesystem::path& file, const LogVisit& visit);

/// A .db3 (plain, or .db3.zstd), or the folder of a bag with its metadata.yaml, of sqlite3 or mcap
/// files; a bag of ROS 1 (.bag), or a folder of them.
[[nodiscard]] bool is_rosbag2(const std::filesystem::path& path);
[[nodiscard]] LogEnd read_rosbag2(const std::filesystem::path& path, const LogVisit& visit);

[[nodiscard]] bool is_wpilog(const std::filesystem::path& file);
[[nodiscard]] LogEnd read_wpilog(const std::filesystem::path& file, const LogVisit& visit);

[[nodiscard]] bool is_roadrunner_log(const std::filesystem::path& file);
[[nodiscard]] LogEnd read_roadrunner_log(const std::filesystem::path& file, const LogVisit& visit);

/// Whether the name ends in .csv, .tsv or .txt, or those with .xz.
[[nodiscard]] bool is_csv_log(const std::filesystem::path& file);
[[nodiscard]] LogEnd read_csv_log(const std::filesystem::path& file, const LogVisit& visit);

/// Whether it is a table, which keeps its times in a column.
[[nodiscard]] bool is_table_log(const std::filesystem::path& path);

/// Whichever it is. Throws InputError where it is none.
[[nodiscard]] bool is_message_log(const std::filesystem::path& path);
[[nodiscard]] LogEnd read_message_log(const std::filesystem::path& path, const LogVisit& visit);

/// Throws InputError where a log holds none at all.
void require_messages(const std::filesystem::path& path, const LogEnd& end);

}  // namespace trussmap::logs
