// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The fields of one message as a tree, whatever format it came in.
//
//   number    floating point                    group   members with names
//   integer   whole, or a boolean as 0 and 1    list    elements without
//   text
//
// Fields lie in one array in the order of the message, each followed by all that is within it; so a
// tree is filled without an allocation once it has grown. Names and texts are views: of the
// definition and of the message, which must outlive what is read from the tree.
//
//   FieldTree tree;                                  FieldRef root = tree.root();
//   const std::size_t group = tree.open_group("");   root.member("x")->number()
//   tree.add_number("x", 1.5);
//   tree.close(group);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

enum class FieldKind : std::uint8_t { number, integer, text, group, list };

struct Field {
  FieldKind kind = FieldKind::number;
  std::string_view name = {};  ///< within its group; empty in a list, and of the root
  double number = std::numeric_limits<double>::quiet_NaN();  ///< of an integer, too
  std::int64_t integer = 0;    ///< exact; an unsigned one beyond its range: the largest
  std::string_view text = {};  ///< of a table's numbers, too: as written
  std::size_t length = 0;      ///< of a list: elements in the message, of which the first are kept
  std::size_t end = 0;         ///< where the next field lies that is not within this one
};

class FieldTree;

/// A field of a tree; valid as long as the tree is unchanged.
class FieldRef {
 public:
  FieldRef(const FieldTree& tree, std::size_t at) : tree_(&tree), at_(at) {}

  [[nodiscard]] const Field& field() const;
  [[nodiscard]] FieldKind kind() const { return field().kind; }
  [[nodiscard]] std::string_view name() const { return field().name; }
  [[nodiscard]] bool is_number() const {
    return kind() == FieldKind::number || kind() == FieldKind::integer;
  }
  /// NaN where it is no number.
  [[nodiscard]] double number() const { return field().number; }
  /// Of a group; none where it is no group, or has no such member.
  [[nodiscard]] std::optional<FieldRef> member(std::string_view name) const;
  /// Of a list, from 0; none where it is no list, or this one was not kept.
  [[nodiscard]] std::optional<FieldRef> element(std::size_t number) const;
  /// Members of a group, or elements of a list that were kept.
  [[nodiscard]] std::vector<FieldRef> children() const;

 private:
  const FieldTree* tree_;
  std::size_t at_;
};

class FieldTree {
 public:
  void clear();
  [[nodiscard]] bool empty() const { return fields_.empty(); }
  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  /// The first field. Precondition: not empty.
  [[nodiscard]] FieldRef root() const { return {*this, 0}; }

  void add_number(std::string_view name, double value, std::string_view text = {});
  void add_integer(std::string_view name, std::int64_t value, std::string_view text = {});
  void add_unsigned(std::string_view name, std::uint64_t value);
  void add_text(std::string_view name, std::string_view value);
  /// What lies between open and close is within; close takes what open returned.
  [[nodiscard]] std::size_t open_group(std::string_view name);
  [[nodiscard]] std::size_t open_list(std::string_view name, std::size_t length);
  void close(std::size_t opened) { fields_[opened].end = fields_.size(); }
  /// A text that is kept until the next clear(): where the message has it in other characters.
  [[nodiscard]] std::string_view keep(std::string text);

 private:
  friend class FieldRef;
  Field& add(FieldKind kind, std::string_view name);

  std::vector<Field> fields_;
  std::deque<std::string> kept_;
};

}  // namespace trussmap::logs
