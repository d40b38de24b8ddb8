// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Several logs read as one: tables beside each other, or a bag and the tables that go with it.
// Topics and messages are those of message_log.hpp, and say which log they are of.
//
//   log       its number, from 0; its name: of its path as much of the end as no other log has
//   folder    all logs in it, in order of their names, but no folders in it
#pragma once

#include "logs/message_log.hpp"
#include "trussmap/log_files.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace trussmap::logs {

/// Throws InputError.
[[nodiscard]] GivenDefinitions given_definitions(const LogOptions& options);

[[nodiscard]] std::vector<LogCount> counts_of(const std::vector<PassedOver>& passed_over);

class JoinedLogs {
 public:
  /// Throws InputError: none, one that is no log, one given twice, a folder without logs.
  explicit JoinedLogs(const std::vector<std::filesystem::path>& paths,
                      GivenDefinitions definitions = nullptr);

  [[nodiscard]] std::size_t size() const { return logs_.size(); }
  [[nodiscard]] const std::filesystem::path& path(std::size_t log) const { return logs_[log]; }
  [[nodiscard]] const std::string& name(std::size_t log) const { return names_[log]; }
  [[nodiscard]] const GivenDefinitions& definitions() const { return definitions_; }
  [[nodiscard]] bool is_table(std::size_t log) const { return tables_[log]; }
  /// All their names, for messages; of a single one its path.
  [[nodiscard]] std::string all_names() const;
  /// Of a log as a map.toml names it: its path, or as much of the end as tells it, with or without
  /// .xz. Throws std::invalid_argument where none is called so, or several are.
  [[nodiscard]] std::size_t named(const std::string& file) const;

  /// Reads those that are needed, one after the other; numbers of topics go on from log to log.
  [[nodiscard]] LogEnd read(const LogVisit& visit,
                            const std::function<bool(std::size_t)>& needed) const;

 private:
  std::vector<std::filesystem::path> logs_;
  std::vector<std::string> names_;
  std::vector<bool> tables_;
  GivenDefinitions definitions_;
};

}  // namespace trussmap::logs
