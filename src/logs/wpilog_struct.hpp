// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// WPILib's packed structs: a schema as text, and bytes that it describes.
//
//   "double x; int16 n[3]; enum {off=0, on=1} uint8 mode:2; Rotation2d angle; char tag[8]"
//
//   type                       bytes    in the tree
//   bool                       1        integer 0 or 1
//   int8 ... int64, uint8 ...  1 ... 8  integer, of an enumeration too
//   float, float32             4        number
//   double, float64            8        number
//   char, char[N]              1, N     text, without the zeros behind it
//   the name of another                 group
//   any of them, [N]                    list
//
// Little endian, without padding. Neighbouring bit-fields of integers of the same size share them,
// from the lowest bit on; those of signed types have a sign.
//
// Source: WPILib Packed Struct Serialization Specification 1.0 (allwpilib,
// wpiutil/doc/struct.adoc).
#pragma once

#include "logs/field_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

struct StructType;

enum class StructKind : std::uint8_t { boolean, character, whole, natural, real, group };

struct StructMember {
  std::string name;
  StructKind kind = StructKind::real;
  std::uint64_t offset = 0;  ///< bytes
  std::uint64_t size = 0;    ///< bytes of one element, or of the integers that bit-fields share
  bool list = false;
  std::uint64_t count = 1;
  unsigned shift = 0;
  unsigned bits = 0;                                 ///< of a bit-field; 0: it is none
  std::shared_ptr<const StructType> type = nullptr;  ///< of a group
};

struct StructType {
  std::vector<StructMember> members;
  std::uint64_t size = 0;    ///< bytes
  std::uint64_t fields = 0;  ///< in the tree
};

/// Fields that one message may have: texts and groups are all kept.
inline constexpr std::uint64_t kMostFields = std::uint64_t{1} << 20U;

/// All schemas of a log; those of WPILib's own structs are known beforehand.
class StructSchemas {
 public:
  /// Whether it is another than what was known by this name.
  bool add(const std::string& name, std::string_view text);
  [[nodiscard]] bool states(const std::string& name) const { return stated_.contains(name); }

  /// The type, or why there is none: "its schema struct:Pose is not in the log".
  struct Found {
    std::shared_ptr<const StructType> type;
    std::string problem;
  };
  [[nodiscard]] Found find(const std::string& name);

 private:
  [[nodiscard]] Found made(const std::string& name, int depth);
  [[nodiscard]] std::string add_member(StructType& type, std::string_view declared, int depth);

  std::map<std::string, std::string> stated_;
  std::map<std::string, std::shared_ptr<const StructType>> types_;
};

/// Precondition: `bytes` has the type's size. Names and texts are views of both.
void decode_struct(const StructType& type, std::string_view bytes, std::string_view name,
                   std::size_t elements, FieldTree& tree);

}  // namespace trussmap::logs
