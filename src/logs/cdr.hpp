// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// ROS 2 messages as they are sent and recorded: CDR (XCDR1, plain).
//
//   bytes   content
//   2       how it is encoded: 00 00 CDR, big-endian; 00 01 CDR, little-endian
//   2       options, not used
//   ...     the fields in the order of the definition
//
//   number             its bytes, at a multiple of its size (counted from after the first 4 bytes)
//   string             length with the closing zero, uint32; characters; zero
//   wstring            number of characters, uint32; characters of 2 bytes each (as specified) or 4
//                      (Fast CDR 1): whichever fits the whole message; an error where both do
//   T[N]               elements
//   T[], T[<=N]        their number, uint32; elements
//   another message    its fields; of one without any, one byte
//
// Of lists of plain numbers the first are kept, the others cost nothing: images and clouds of
// points. What has a length is checked against the bytes that are there before anything is made.
//
// Messages of ROS 1 are the same without the first 4 bytes, little-endian, and without gaps:
// numbers stand where they come, strings have no zero at their end, a message without fields no
// byte.
//
// Source: DDS-XTypes 1.3, 7.4; DDSI-RTPS 2.5, 10; ROS wiki, "msg" and "Technical Overview".
#pragma once

#include "logs/field_tree.hpp"
#include "logs/ros2_definition.hpp"

#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace trussmap::logs {

/// What is wrong with a message: "needs 8 bytes for pose, 3 are left".
class CdrError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Fields of a message that are kept at most; further elements of lists are left out.
inline constexpr std::size_t kMostMessageFields = std::size_t{1} << 19U;

/// Fills a tree with a message; its names are views of the layout, its texts of the message. Throws
/// CdrError where the message does not end where its fields do (to 3 bytes, which some senders
/// add).
void decode_cdr(std::string_view message, const Ros2Layout& layout, std::size_t elements,
                FieldTree& tree);

/// The same of a message of ROS 1, with a layout of parse_ros1_definition. Throws CdrError where
/// the message does not end where its fields do.
void decode_ros1(std::string_view message, const Ros2Layout& layout, std::size_t elements,
                 FieldTree& tree);

}  // namespace trussmap::logs
