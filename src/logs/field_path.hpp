// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths to fields: TOPIC/field.sub[i], as map.toml and inspections write them.
//
//   /odom/twist.twist.linear.x          members of members
//   /scan/ranges[3]                     an element, from 0
//   /joint_states/position[left_wheel]  the element whose fellow in the list `name` beside it is so
//   /poses/markers[id=5].pose           the element whose member `id` is so
//   /battery                            the message itself, where it is a number
//   .                                   (below a topic) the message itself
//   Left (mm)                           of a table: the column, with whatever characters
//   column 3                            the same by its number, from 1, where none is called so
#pragma once

#include "logs/field_tree.hpp"
#include "logs/message_log.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

/// Whether the path's topic is this one.
[[nodiscard]] bool is_of_topic(std::string_view path, const LogTopic& topic);

/// The part of a path below the message of its topic.
class FieldPath {
 public:
  FieldPath() = default;  ///< the message itself
  /// `below`: what follows the topic, without the slash; of a table: the column. Throws
  /// std::invalid_argument where a bracket is not closed or a name is empty.
  FieldPath(std::string_view below, bool table);
  /// Of a whole path; precondition: is_of_topic.
  static FieldPath below_topic(std::string_view path, const LogTopic& topic);

  [[nodiscard]] std::optional<FieldRef> find(FieldRef from) const;
  [[nodiscard]] bool is_empty() const { return steps_.empty(); }

 private:
  struct Step {
    enum class Kind { member, number, fellow, key } kind = Kind::member;
    std::string name;        ///< member; key
    std::string value;       ///< what the fellow or the key's value is
    std::size_t number = 0;  ///< of an element; of a column, from 1, where its name has one
  };
  std::vector<Step> steps_;
};

/// A field as a name: its text, or a whole number's digits; empty of anything else.
[[nodiscard]] std::string as_text(FieldRef field);

/// All fields of a message that are numbers or texts, with their paths below it; of lists the first
/// `elements` only.
struct NamedField {
  std::string path;
  FieldRef field;
};
[[nodiscard]] std::vector<NamedField> leaves_of(FieldRef root, std::size_t elements);

}  // namespace trussmap::logs
