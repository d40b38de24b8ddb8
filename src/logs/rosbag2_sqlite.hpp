// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The SQLite files (.db3) of a rosbag2. Tables and columns that are read:
//
//   topics                 id, name, type, serialization_format
//   messages               topic_id, timestamp (ns), data
//   message_definitions    topic_type, encoding, encoded_message_definition (since ROS 2 Iron)
//
// Messages come in the order in which they were written; data of topics that nobody wants are not
// read. The file is opened as one that nobody writes to: what a recorder left beside it (-wal,
// -journal) is not taken in, and said to be there.
//
// Source: rosbag2_storage_sqlite3, versions 2 to 4 of its schema.
#pragma once

#include "logs/bag_topics.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace trussmap::logs {

/// What is left out at the end; empty: nothing. Calls `opened` once the file is open. Throws
/// InputError with `shown` for the name of the file.
[[nodiscard]] std::string read_rosbag2_sqlite(const std::filesystem::path& file,
                                              const std::string& shown, BagTopics& topics,
                                              const std::function<void()>& opened);

}  // namespace trussmap::logs
