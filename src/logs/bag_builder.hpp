// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A bag from messages in any order: topics as they come, messages in the order of time.
#pragma once

#include "logs/ros_messages.hpp"
#include "trussmap/log_files.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace trussmap::logs {

/// The name with what no topic of ROS 2 may have replaced: letters, digits and single underscores,
/// no digit first. "tag36h11:5" becomes tag36h11_5, "5" landmark_5.
[[nodiscard]] std::string topic_token(const std::string& name);

class BagBuilder {
 public:
  /// `name` stands for what the times come from in messages. `first` is the earliest of them, s.
  BagBuilder(const std::string& name, const BagOptions& options, double first);

  /// ns, of a time in s. Throws InputError where ROS has no such time.
  [[nodiscard]] std::int64_t stamp(double t) const;
  [[nodiscard]] RosHeader header(double t, std::string frame) const {
    return {stamp(t), std::move(frame)};
  }

  /// Throws InputError where there are more topics than a bag can number.
  void add(const std::string& topic, const char* type, double t, std::string data);
  /// A topic below `folder` of its own, told from others that ROS would call the same.
  [[nodiscard]] std::string topic_below(const std::string& folder, const std::string& name);
  void leave_out(std::size_t count, const std::string& what);

  [[nodiscard]] Bag finish();

 private:
  struct Message {
    std::int64_t time = 0;
    std::size_t topic = 0;
    std::string data;
  };

  std::string name_;
  std::vector<Message> messages_;
  std::map<std::string, std::size_t> numbers_;  // of topics
  std::map<std::string, std::string> below_;    // topic: what it was made of
  Bag bag_;
};

}  // namespace trussmap::logs
