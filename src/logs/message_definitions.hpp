// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Definitions of messages (.msg) out of files and folders, for bags that lack them.
//
//   my_msgs/msg/Wheel.msg    my_msgs/Wheel: the package is the folder, of msg/ the one above
//   my_msgs/Wheel.msg        the same
//
// Each is its own text alone; types within it are looked for by their names (ros2_definition.hpp).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace trussmap::logs {

class MessageDefinitions {
 public:
  struct Definition {
    std::string text;
    std::string file;
  };

  /// Of .msg files, and of folders with all in them, at any depth. Throws InputError where there is
  /// none, where one is too large, and where a type stands twice with different texts.
  explicit MessageDefinitions(const std::vector<std::filesystem::path>& paths);

  /// Of PACKAGE/NAME; nothing: none.
  [[nodiscard]] const Definition* find(const std::string& type) const;

 private:
  void add_file(const std::filesystem::path& file);
  void add_folder(const std::filesystem::path& folder);

  std::map<std::string, Definition> by_type_;
  std::size_t bytes_ = 0;
};

/// Nothing: none were given.
using GivenDefinitions = std::shared_ptr<const MessageDefinitions>;

}  // namespace trussmap::logs
