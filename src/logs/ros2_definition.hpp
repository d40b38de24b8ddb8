// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Definitions of ROS 2 messages (.msg), as bags keep them: the message's own first, then those of
// the types within it, in any order.
//
//   # comment                               std_msgs/Header header     another type's
//   int32 OK=0          a constant          float64[36] covariance     exactly so many
//   int32 status 1      with a default      string<=20[<=5] names      at most so many
//   ========================================  (80 of them)
//   MSG: std_msgs/Header
//   builtin_interfaces/Time stamp
//   string frame_id
//
// They become a layout: groups of fields in the order in which a message has them, each once. A
// type that the text lacks is one that was given (message_definitions.hpp), or that of the standard
// messages (ros2_standard.hpp).
//
// ROS 1 writes them alike. There `time` and `duration` are plain types, here groups of `sec` and
// `nanosec`, as in ROS 2, so that a path leads to the same in both; `byte` has a sign; `Header` is
// that of std_msgs, which has `seq`; and a bag has the definitions of all that is within.
//
// Refused are types that contain themselves, and what is larger than any true one: definitions may
// be written by anybody.
//
// Source: the ROS 2 documentation, "Interfaces"; ROS wiki, "msg"; the registry of MCAP, "ros2msg"
// and "ros1msg".
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

class MessageDefinitions;

/// Why a definition cannot be used: "line 3 of its definition: ...".
class DefinitionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Ros2Type : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  text,
  wide_text,
  group
};

/// Bytes of one in a message; 0 of texts and groups, which have no size of their own.
[[nodiscard]] std::size_t size_of(Ros2Type type);

enum class Ros2List : std::uint8_t { none, fixed, sequence };

struct Ros2Field {
  std::string name;
  Ros2Type type = Ros2Type::boolean;
  std::size_t group = 0;  ///< of type group: its place in the layout
  Ros2List list = Ros2List::none;
  std::uint64_t count = 0;    ///< of a list: exactly (fixed), at most (sequence)
  std::uint64_t longest = 0;  ///< of a text: characters at most
};

struct Ros2Group {
  std::string type;  ///< PACKAGE/NAME
  std::vector<Ros2Field> fields;
  /// Bytes that one has in a message at least; 1 or more, but in ROS 1, where an empty one has
  /// none.
  std::uint64_t least = 0;
  std::uint64_t all = 0;  ///< fields within it, those of lists once
  std::size_t depth = 0;  ///< groups one within the other
};

struct Ros2Layout {
  std::vector<Ros2Group> groups;  ///< the first is the message
  bool wide = false;              ///< has wide texts
};

/// "std_msgs/msg/Header" and "std_msgs/Header" are the latter.
[[nodiscard]] std::string ros2_type_name(std::string_view type);

/// Of a message of this type; with a blank text of the given or the standard one. Throws
/// DefinitionError.
[[nodiscard]] Ros2Layout parse_ros2_definition(std::string_view type, std::string_view text,
                                               const MessageDefinitions* given = nullptr);

/// The same of ROS 1, whose text has all types within. Throws DefinitionError.
[[nodiscard]] Ros2Layout parse_ros1_definition(std::string_view type, std::string_view text);

}  // namespace trussmap::logs
