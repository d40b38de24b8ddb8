// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/field_path.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace trussmap::logs {
namespace {

/// Lists of names that go with lists of values: JointState's.
constexpr std::string_view kNameLists[] = {"name", "names", "joint_names"};

std::optional<FieldRef> by_fellow(std::optional<FieldRef> group, FieldRef list,
                                  std::string_view wanted) {
  if (!group) return std::nullopt;
  for (const std::string_view one : kNameLists) {
    const std::optional<FieldRef> names = group->member(one);
    if (!names || names->kind() != FieldKind::list) continue;
    const std::vector<FieldRef> all = names->children();
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].field().text == wanted) return list.element(k);
    }
  }
  return std::nullopt;
}

std::optional<FieldRef> by_key(FieldRef list, std::string_view key, std::string_view wanted) {
  if (list.kind() != FieldKind::list) return std::nullopt;
  for (const FieldRef& one : list.children()) {
    const std::optional<FieldRef> value = one.member(key);
    if (value && as_text(*value) == wanted) return one;
  }
  return std::nullopt;
}

/// 3 of "column 3"; 0 of anything else.
std::size_t column_number(std::string_view name) {
  constexpr std::string_view kColumn = "column ";
  std::size_t number = 0;
  if (!name.starts_with(kColumn)) return 0;
  name.remove_prefix(kColumn.size());
  const auto [last, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && last == name.data() + name.size() ? number : 0;
}

/// Of a table's row, from 1.
std::optional<FieldRef> column(FieldRef row, std::size_t number) {
  const std::vector<FieldRef> all = row.children();
  return number <= all.size() ? std::optional(all[number - 1]) : std::nullopt;
}

void collect(FieldRef field, const std::string& path, std::size_t elements,
             std::vector<NamedField>& found) {
  const FieldKind kind = field.kind();
  if (kind == FieldKind::group) {
    for (const FieldRef& one : field.children()) {
      const std::string name(one.name());
      std::string below = path;
      if (!below.empty()) below += '.';
      below += name;
      collect(one, below, elements, found);
    }
  } else if (kind == FieldKind::list) {
    for (std::size_t k = 0; k < elements; ++k) {
      const std::optional<FieldRef> one = field.element(k);
      if (!one) return;
      collect(*one, path + '[' + std::to_string(k) + ']', elements, found);
    }
  } else {
    found.push_back({path, field});
  }
}

}  // namespace

bool is_of_topic(std::string_view path, const LogTopic& topic) {
  if (topic.table) return true;
  if (!path.starts_with(topic.name)) return false;
  return path.size() == topic.name.size() || path[topic.name.size()] == '/' ||
         path[topic.name.size()] == '[';
}

FieldPath FieldPath::below_topic(std::string_view path, const LogTopic& topic) {
  path.remove_prefix(topic.name.size());
  // A table's column may begin with a slash of its own.
  if (!topic.table && path.starts_with('/')) path.remove_prefix(1);
  return {path, topic.table};
}

FieldPath::FieldPath(std::string_view below, bool table) {
  if (below == ".") return;  // the message itself
  if (table) {
    if (!below.empty()) {
      steps_.push_back({Step::Kind::member, std::string(below), "", column_number(below)});
    }
    return;
  }
  const auto fail = [below](const std::string& what) {
    throw std::invalid_argument("the path \"" + std::string(below) + "\" " + what +
                                ", expected field.sub[i]");
  };
  std::size_t at = 0;
  while (at < below.size()) {
    Step step;
    if (below[at] == '[') {
      const std::size_t end = below.find(']', at);
      if (end == std::string_view::npos) fail("has a bracket that is not closed");
      const std::string_view within = below.substr(at + 1, end - at - 1);
      const std::size_t equals = within.find('=');
      const auto [last, error] =
          std::from_chars(within.data(), within.data() + within.size(), step.number);
      if (error == std::errc() && last == within.data() + within.size()) {
        step.kind = Step::Kind::number;
      } else if (equals != std::string_view::npos) {
        step.kind = Step::Kind::key;
        step.name = within.substr(0, equals);
        step.value = within.substr(equals + 1);
      } else {
        step.kind = Step::Kind::fellow;
        step.value = within;
      }
      if (within.empty()) fail("has empty brackets");
      at = end + 1;
    } else {
      if (below[at] == '.' && at > 0) ++at;
      const std::size_t end = std::min(below.find_first_of(".[", at), below.size());
      step.name = below.substr(at, end - at);
      if (step.name.empty()) fail("has an empty name");
      at = end;
    }
    steps_.push_back(std::move(step));
  }
}

std::optional<FieldRef> FieldPath::find(FieldRef from) const {
  std::optional<FieldRef> group;  // that `at` is a member of
  std::optional<FieldRef> at = from;
  for (const Step& step : steps_) {
    std::optional<FieldRef> next;
    switch (step.kind) {
      case Step::Kind::member:
        next = at->member(step.name);
        if (!next && step.number > 0) next = column(*at, step.number);
        break;
      case Step::Kind::number:
        next = at->element(step.number);
        break;
      case Step::Kind::fellow:
        next = by_fellow(group, *at, step.value);
        break;
      case Step::Kind::key:
        next = by_key(*at, step.name, step.value);
        break;
    }
    if (!next) return std::nullopt;
    group = at;
    at = next;
  }
  return at;
}

std::string as_text(FieldRef field) {
  if (field.kind() == FieldKind::text) return std::string(field.field().text);
  if (field.kind() == FieldKind::integer) return std::to_string(field.field().integer);
  constexpr double kWhole = 1e15;
  const double number = field.number();
  if (field.kind() == FieldKind::number && number == number &&
      number ==
          static_cast<double>(static_cast<std::int64_t>(std::clamp(number, -kWhole, kWhole)))) {
    return std::to_string(static_cast<std::int64_t>(number));
  }
  return {};
}

std::vector<NamedField> leaves_of(FieldRef root, std::size_t elements) {
  std::vector<NamedField> found;
  collect(root, "", elements, found);
  return found;
}

}  // namespace trussmap::logs
