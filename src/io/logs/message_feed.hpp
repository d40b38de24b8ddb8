// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Who wants which field of a log: paths with what takes their messages, and what is said where the
// log has no such field.
#pragma once

#include "io/logs/field_path.hpp"
#include "io/logs/log_map.hpp"
#include "io/logs/message_log.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>

namespace trussmap {

/// A message with the field that a path leads to.
struct FedMessage {
  const LogTopic& topic;
  FieldRef message;
  FieldRef field;
  std::int64_t t;  ///< ns, by the map's [time]
};

class MessageFeeds {
 public:
  explicit MessageFeeds(const LogMap& map) : map_(&map) {}

  /// False: the field is not what was expected.
  using Take = std::function<bool(const FedMessage&)>;
  void add(const std::string& path, std::size_t line, Take take);
  /// The whole message of the topic of this path, in place of the field.
  void add_message(const std::string& path, std::size_t line, Take take);

  [[nodiscard]] bool wants(const LogTopic& topic) const;
  void take(const LogMessage& message);

  /// ns; `timed` is what has the header: the message, or one of its transforms.
  [[nodiscard]] std::int64_t time_of(const LogMessage& message, FieldRef timed);

  /// Messages whose field was not what was expected: a text where a number belongs.
  [[nodiscard]] std::size_t refused() const;

  /// After the last message: throws InputError with the map's line where a path led to nothing.
  void check(const std::filesystem::path& log, const LogEnd& end) const;

 private:
  struct Feed {
    std::string path;
    std::size_t line = 0;
    bool whole = false;
    Take take;
    std::map<std::size_t, FieldPath> by_topic = {};
    std::size_t taken = 0;
    std::size_t refused = 0;  ///< found, but not what was expected
    std::string fields = {};  ///< that a message of its topic has
  };

  [[noreturn]] void fail(const Feed& feed, const std::filesystem::path& log,
                         const LogEnd& end) const;

  const LogMap* map_;
  std::deque<Feed> feeds_;
  std::map<std::size_t, std::vector<Feed*>> by_topic_;
  std::map<std::size_t, FieldPath> times_;
};

/// ns of a time in s.
[[nodiscard]] std::int64_t nanoseconds(double seconds);

}  // namespace trussmap
