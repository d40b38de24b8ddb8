// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/field_tree.hpp"

#include <algorithm>

namespace trussmap::logs {

const Field& FieldRef::field() const {
  return tree_->fields_[at_];
}

std::optional<FieldRef> FieldRef::member(std::string_view name) const {
  if (kind() != FieldKind::group) return std::nullopt;
  const std::size_t end = field().end;
  for (std::size_t at = at_ + 1; at < end; at = tree_->fields_[at].end) {
    if (tree_->fields_[at].name == name) return FieldRef(*tree_, at);
  }
  return std::nullopt;
}

std::optional<FieldRef> FieldRef::element(std::size_t number) const {
  if (kind() != FieldKind::list) return std::nullopt;
  const std::size_t end = field().end;
  for (std::size_t at = at_ + 1; at < end; at = tree_->fields_[at].end) {
    if (number-- == 0) return FieldRef(*tree_, at);
  }
  return std::nullopt;
}

std::vector<FieldRef> FieldRef::children() const {
  std::vector<FieldRef> found;
  const std::size_t end = field().end;
  for (std::size_t at = at_ + 1; at < end; at = tree_->fields_[at].end) {
    found.emplace_back(*tree_, at);
  }
  return found;
}

void FieldTree::clear() {
  fields_.clear();
  kept_.clear();
}

Field& FieldTree::add(FieldKind kind, std::string_view name) {
  Field& field = fields_.emplace_back();
  field.kind = kind;
  field.name = name;
  field.end = fields_.size();
  return field;
}

void FieldTree::add_number(std::string_view name, double value, std::string_view text) {
  Field& field = add(FieldKind::number, name);
  field.number = value;
  field.text = text;
}

void FieldTree::add_integer(std::string_view name, std::int64_t value, std::string_view text) {
  Field& field = add(FieldKind::integer, name);
  field.text = text;
  field.integer = value;
  field.number = static_cast<double>(value);
}

void FieldTree::add_unsigned(std::string_view name, std::uint64_t value) {
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  Field& field = add(FieldKind::integer, name);
  field.integer = static_cast<std::int64_t>(std::min(value, kLargest));
  field.number = static_cast<double>(value);
}

void FieldTree::add_text(std::string_view name, std::string_view value) {
  add(FieldKind::text, name).text = value;
}

std::size_t FieldTree::open_group(std::string_view name) {
  add(FieldKind::group, name);
  return fields_.size() - 1;
}

std::size_t FieldTree::open_list(std::string_view name, std::size_t length) {
  add(FieldKind::list, name).length = length;
  return fields_.size() - 1;
}

std::string_view FieldTree::keep(std::string text) {
  return kept_.emplace_back(std::move(text));
}

}  // namespace trussmap::logs
