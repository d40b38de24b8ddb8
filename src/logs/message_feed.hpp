// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Who wants which field of which log: paths with what takes their messages, and what is said where
// the logs have no such field.
#pragma once

#include "logs/field_path.hpp"
#include "logs/joined_logs.hpp"
#include "logs/log_map.hpp"
#include "logs/message_log.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

/// A message with the field that a path leads to.
struct FedMessage {
  const LogTopic& topic;
  FieldRef message;
  FieldRef field;
  std::int64_t t;         ///< ns, by the map's [time]
  std::uint64_t row = 0;  ///< LogMessage::row
};

/// What a table of the map asks for.
struct AskedField {
  const std::string& path;
  const std::string& file;  ///< the log; empty: the only one, or any bag
  std::size_t line = 0;     ///< of the map
};

class MessageFeeds {
 public:
  /// Both must outlive it. Throws InputError where [time] is of a file that is not there.
  MessageFeeds(const LogMap& map, const JoinedLogs& logs);

  /// False: the field is not what was expected.
  using Take = std::function<bool(const FedMessage&)>;
  /// Throws InputError where the file is not there, or must be stated and is not.
  void add(const AskedField& asked, Take take);
  /// The whole message of the topic of this path, in place of the field.
  void add_message(const AskedField& asked, Take take);

  [[nodiscard]] bool wants(const LogTopic& topic) const;
  /// Whether any feed is of this log.
  [[nodiscard]] bool wants_of(std::size_t log) const;
  void take(const LogMessage& message);

  /// ns; `timed` is what has the header: the message, or one of its transforms.
  [[nodiscard]] std::int64_t time_of(const LogMessage& message, FieldRef timed);

  /// Messages whose field was not what was expected: a text where a number belongs; and where the
  /// first one was.
  [[nodiscard]] std::size_t refused() const;
  [[nodiscard]] const std::string& first_refused() const { return first_refused_; }
  /// From within a Take that returns false: another field than its own was not what was expected.
  void blame(const std::string& path, FieldRef field);

  /// After the last message: throws InputError with the map's line where a path led to nothing.
  void check(const LogEnd& end) const;

 private:
  struct Feed {
    std::string path;
    std::size_t line = 0;
    std::optional<std::size_t> log = {};  ///< none: any bag
    bool whole = false;
    Take take;
    std::map<std::size_t, FieldPath> by_topic = {};
    std::size_t taken = 0;
    std::size_t refused = 0;  ///< found, but not what was expected
    std::string fields = {};  ///< that a message of its topic has
  };
  struct TimePaths {
    FieldPath field, fraction;
  };

  [[nodiscard]] std::optional<std::size_t> log_of(const AskedField& asked) const;
  [[nodiscard]] bool is_of(const Feed& feed, const LogTopic& topic) const;
  void meet(const LogMessage& message);
  [[nodiscard]] std::int64_t field_time(const LogMessage& message, const TimeMap& time);
  [[nodiscard]] std::string place_of(const LogMessage& message) const;
  [[noreturn]] void fail(const Feed& feed, const LogEnd& end) const;

  const LogMap* map_;
  const JoinedLogs* logs_;
  std::vector<const TimeMap*> times_;  ///< of each log; nothing: none is stated
  std::deque<Feed> feeds_;
  std::map<std::size_t, std::vector<Feed*>> by_topic_;
  std::map<std::size_t, TimePaths> time_paths_;
  std::string first_refused_;
  std::string blamed_;
};

/// ns of a time in s.
[[nodiscard]] std::int64_t nanoseconds(double seconds);

/// What follows its topic in a whole path; of a table the column itself.
[[nodiscard]] std::string below_topic(const std::string& path, const LogTopic& topic);

}  // namespace trussmap::logs
