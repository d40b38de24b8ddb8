// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths below messages that a map asks for, and whether any message had them: one that none has is
// a slip of the pen, and must not count as a reading that is absent.
#pragma once

#include "logs/field_path.hpp"
#include "logs/log_map.hpp"

#include <map>
#include <string>
#include <utility>

namespace trussmap::logs {

class AskedPaths {
 public:
  explicit AskedPaths(const LogMap& map) : map_(&map) {}

  /// The field at a path below `from`; none where the path is empty or the message lacks it. Throws
  /// InputError with the map's line where it is no path.
  [[nodiscard]] std::optional<FieldRef> find(const std::string& path, std::size_t line,
                                             const LogTopic& topic, FieldRef from);
  /// The same as a number, NaN where there is none.
  [[nodiscard]] double number(const std::string& path, std::size_t line, const LogTopic& topic,
                              FieldRef from);

  /// After the last message: throws InputError where a path that was looked for was never found.
  void check() const;

 private:
  struct Asked {
    FieldPath path;
    bool found = false;
    std::string fields;  ///< that a message had in its place
    std::string file;    ///< of the log
  };

  const LogMap* map_;
  std::map<std::pair<std::size_t, std::string>, Asked> asked_;  ///< by line and path
};

/// Paths of the fields of a message, those of its first ones, with commas between.
[[nodiscard]] std::string listed_fields(FieldRef message);

}  // namespace trussmap::logs
