// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The topics of a ROS bag, in all its files: what readers of MCAP, SQLite and ROS 1 have in common.
//
// Several channels (of one file or of many) may carry the same topic. A channel's messages are
// decoded by the definition that the bag has of its type, or by the given or the standard one.
#pragma once

#include "logs/decompress.hpp"
#include "logs/message_log.hpp"
#include "logs/ros2_definition.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

/// As a file describes it.
struct BagChannel {
  std::string topic;
  std::string type;
  std::string encoding;          ///< of messages: cdr, ros1
  std::string schema_encoding;   ///< ros2msg, ros1msg, ros2idl, ...; empty: none
  std::string_view definition;   ///< needed during the call alone
  bool definition_known = true;  ///< false: left out as too large
};

class BagTopics {
 public:
  explicit BagTopics(const LogVisit& visit) : visit_(&visit) {}

  /// Number of the channel, for the calls below.
  [[nodiscard]] std::size_t add(const BagChannel& channel);

  /// One more message; whether it is to be delivered.
  [[nodiscard]] bool count(std::size_t channel);

  /// `fail` is called with what is wrong with the message, and throws.
  void deliver(std::size_t channel, std::uint64_t log_time, std::uint64_t publish_time,
               std::string_view data, const std::function<void(const std::string&)>& fail);

  [[nodiscard]] const std::string& name(std::size_t channel) const;
  [[nodiscard]] std::vector<LogTopic> all() const { return {topics_.begin(), topics_.end()}; }

 private:
  struct Channel {
    std::size_t topic = 0;
    std::string type;
    std::string encoding;
    std::string unread;
    std::shared_ptr<const Ros2Layout> layout;
  };
  struct Definition {
    std::shared_ptr<const Ros2Layout> layout;
    std::string unread;
  };

  [[nodiscard]] Definition definition_of(const BagChannel& channel);
  bool ask(Channel& channel);

  const LogVisit* visit_;
  std::deque<LogTopic> topics_;  // stay where they are: messages refer to them
  std::map<std::string, std::size_t> numbers_;
  // By what tells one kind of messages of a topic from another: whether they are wanted.
  std::map<std::string, bool> wanted_;
  std::vector<Channel> channels_;
  std::vector<std::optional<bool>> asked_;  // of a channel
  std::map<std::string, Definition> definitions_;
  FieldTree tree_;
  Decompressor decompressor_;
};

}  // namespace trussmap::logs
