// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the records of a WPILib data log hold.
//
//   type             payload                                in the tree
//   boolean          1 byte                                 integer 0 or 1
//   int64            8                                      integer
//   float, double    4, 8                                   number
//   string, json     all of it                              text
//   TYPE[]           one behind the other                   list
//   string[]         u32 count, each as u32 length and text list
//   struct:NAME      by its schema (wpilog_struct.hpp)      group
//   structschema     the schema that the entry's name ends  none: it is no message
//                    with, "/.schema/struct:NAME"
//
// All others are unread. Little endian.
#pragma once

#include "logs/byte_reader.hpp"
#include "logs/field_tree.hpp"
#include "logs/wpilog_struct.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace trussmap::logs {

enum class WpilogContent : std::uint8_t {
  boolean,
  whole,
  single,
  real,
  text,
  structure,
  schema,
  unread
};

struct WpilogType {
  std::string name;  ///< as the log has it
  WpilogContent content = WpilogContent::unread;
  bool list = false;
  std::size_t size = 0;                    ///< bytes of an element of a fixed size
  std::string structure;                   ///< the name of a struct or of that of a schema
  std::shared_ptr<const StructType> type;  ///< of a struct, as soon as it is known
  std::string unread;                      ///< why it is
};

/// Of an entry.
[[nodiscard]] WpilogType wpilog_type(const std::string& entry, const std::string& type);

/// The payload of a record as a tree. Throws InputError. Preconditions: the type is neither unread
/// nor a schema, and that of a struct is known.
void decode_wpilog(const WpilogType& type, ByteReader& payload, std::size_t elements,
                   FieldTree& tree);

}  // namespace trussmap::logs
