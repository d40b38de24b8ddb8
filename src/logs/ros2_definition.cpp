// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/ros2_definition.hpp"

#include "logs/message_definitions.hpp"
#include "logs/ros2_standard.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace trussmap::logs {
namespace {

constexpr std::size_t kLongestText = std::size_t{1} << 20U;  // bytes
constexpr std::size_t kDeepestType = 32;
constexpr std::size_t kMostGroups = 1000;
constexpr std::uint64_t kMostTypeFields = 100000;  // those of lists once
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 40U;
constexpr std::size_t kShortestLine = 10;  // of = between two definitions
constexpr std::uint64_t kMostElements = std::numeric_limits<std::uint32_t>::max();

using Named = std::pair<std::string_view, Ros2Type>;
constexpr std::array<Named, 16> kPlain{{{"bool", Ros2Type::boolean},
                                        {"byte", Ros2Type::uint8},
                                        {"char", Ros2Type::uint8},
                                        {"octet", Ros2Type::uint8},
                                        {"float32", Ros2Type::float32},
                                        {"float64", Ros2Type::float64},
                                        {"int8", Ros2Type::int8},
                                        {"uint8", Ros2Type::uint8},
                                        {"int16", Ros2Type::int16},
                                        {"uint16", Ros2Type::uint16},
                                        {"int32", Ros2Type::int32},
                                        {"uint32", Ros2Type::uint32},
                                        {"int64", Ros2Type::int64},
                                        {"uint64", Ros2Type::uint64},
                                        {"string", Ros2Type::text},
                                        {"wstring", Ros2Type::wide_text}}};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string_view without_spaces(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// The text up to where `ends` says so, taken off its front.
template <typename Ends>
std::string_view taken(std::string_view& text, const Ends& ends) {
  const auto end = std::find_if(text.begin(), text.end(), ends);
  const auto count = static_cast<std::size_t>(end - text.begin());
  const std::string_view found = text.substr(0, count);
  text.remove_prefix(count);
  return found;
}

std::string_view next_line(std::string_view& text) {
  const std::string_view line = taken(text, [](char c) { return c == '\n'; });
  if (!text.empty()) text.remove_prefix(1);
  return without_spaces(line);
}

constexpr std::string_view kRos1Time = "builtin_interfaces/Time";
constexpr std::string_view kRos1Duration = "builtin_interfaces/Duration";

/// What is a plain type in ROS 1, as a group; nothing of other types.
std::string_view time_of_ros1(std::string_view type) {
  if (type == kRos1Time) return "uint32 sec\nuint32 nanosec";
  return type == kRos1Duration ? "int32 sec\nint32 nanosec" : std::string_view();
}

/// The part of a definition that is of one type.
struct Section {
  std::string_view text;
  std::size_t line = 1;      // where it begins
  std::string_view of = {};  // whose lines they are; empty: nobody's whom a user could ask
};

constexpr std::string_view kOfBag = "its definition";

class Parser {
 public:
  Parser(std::string_view type, std::string_view text, bool ros1, const MessageDefinitions* given)
      : ros1_(ros1), given_(given) {
    if (text.size() > kLongestText) {
      throw DefinitionError("its definition has more than " + std::to_string(kLongestText) +
                            " bytes");
    }
    const auto blank = [](char c) { return is_space(c) || c == '\n'; };
    if (ros1 || !std::all_of(text.begin(), text.end(), blank)) split(ros2_type_name(type), text);
  }

  Ros2Layout layout(std::string_view type) {
    static_cast<void>(group(ros2_type_name(type), 1));
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string of(of_.empty() ? kOfBag : of_);
    throw DefinitionError((of_.empty() ? "" : "line " + std::to_string(line_) + " of ") + of +
                          ": " + what);
  }

  void split(const std::string& type, std::string_view text) {
    std::string name = type;
    const char* const whole = text.data();
    const char* begin = whole;
    std::size_t first = 1;
    const auto end_section = [&](const char* end) {
      sections_.try_emplace(name,
                            Section{{begin, static_cast<std::size_t>(end - begin)}, first, kOfBag});
    };
    while (!text.empty()) {
      const char* const at = text.data();
      ++line_;
      const std::string_view line = next_line(text);
      if (line.size() < kShortestLine || line.find_first_not_of('=') != std::string_view::npos) {
        continue;
      }
      end_section(at);
      ++line_;
      std::string_view next = next_line(text);
      if (!next.starts_with("MSG:")) fail("\"MSG: TYPE\" is expected after a line of =");
      next.remove_prefix(4);
      name = ros2_type_name(without_spaces(next));
      begin = text.data();
      first = line_ + 1;
    }
    end_section(text.data());
  }

  /// The section of a type, as written within `package`.
  std::optional<std::pair<std::string, Section>> find(const std::string& type,
                                                      const std::string& package) const {
    std::vector<std::string> names{type};
    if (type.find('/') == std::string::npos) {
      std::string near = package;
      near.append("/").append(type);
      names = {std::move(near), type, std::string("std_msgs/").append(type)};
      if (ros1_ && type == "Header") names = {names.back()};
    }
    for (const std::string& name : names) {
      if (const auto known = sections_.find(name); known != sections_.end()) {
        return {{name, known->second}};
      }
      if (const auto* given = given_ == nullptr ? nullptr : given_->find(name)) {
        return {{name, Section{given->text, 1, given->file}}};
      }
      const std::string_view text = ros1_ ? time_of_ros1(name) : standard_ros2_definition(name);
      if (text.data() != nullptr) {
        return {{name, Section{text, 1}}};
      }
    }
    return std::nullopt;
  }

  std::size_t group(const std::string& type, std::size_t depth) {
    const std::string package = package_.empty() ? type.substr(0, type.find('/')) : package_.back();
    const auto found = find(type, package);
    if (!found && package_.empty()) {
      throw DefinitionError("the bag has no definition of " + type +
                            "; --definitions takes its .msg file");
    }
    if (!found) fail("type " + type + " is not defined");
    const auto& [name, section] = *found;
    if (const auto known = done_.find(name); known != done_.end()) {
      if (layout_.groups[known->second].depth == 0) fail("type " + name + " contains itself");
      return known->second;
    }
    if (depth > kDeepestType) fail("its types are nested too deep");
    if (layout_.groups.size() == kMostGroups) fail("it has too many types");
    const std::size_t at = layout_.groups.size();
    layout_.groups.emplace_back().type = name;
    done_.emplace(name, at);
    package_.push_back(name.substr(0, name.find('/')));
    const auto [line, of] = std::pair(line_, of_);
    Ros2Group filled = fields_of(section, depth);
    filled.type = name;
    layout_.groups[at] = std::move(filled);
    line_ = line;
    of_ = of;
    package_.pop_back();
    return at;
  }

  Ros2Group fields_of(const Section& section, std::size_t depth) {
    Ros2Group result;
    line_ = section.line - 1;
    of_ = section.of;
    std::string_view text = section.text;
    while (!text.empty()) {
      ++line_;
      std::string_view line = next_line(text);
      if (line.empty() || line.front() == '#') continue;
      if (std::optional<Ros2Field> field = field_of(line, depth)) add(result, std::move(*field));
    }
    if (!ros1_) result.least = std::max<std::uint64_t>(result.least, 1);  // an empty one has a byte
    result.depth += 1;
    if (result.depth > kDeepestType) fail("its types are nested too deep");
    return result;
  }

  void add(Ros2Group& group, Ros2Field field) const {
    for (const Ros2Field& one : group.fields) {
      if (one.name == field.name) fail("two fields have the name " + field.name);
    }
    std::uint64_t least = size_of(field.type);
    std::uint64_t all = 1;
    if (field.type == Ros2Type::group) {
      const Ros2Group& inner = layout_.groups[field.group];
      least = inner.least;
      all += inner.all;
      group.depth = std::max(group.depth, inner.depth);
    } else if (least == 0) {
      least = sizeof(std::uint32_t);  // a text's length
    }
    if (field.list == Ros2List::sequence) least = sizeof(std::uint32_t);
    if (field.list == Ros2List::fixed) least *= field.count;
    group.least = std::min(group.least + least, kMostBytes);
    group.all += all;
    if (group.all > kMostTypeFields)
      fail("it has more than " + std::to_string(kMostTypeFields) + " fields");
    group.fields.push_back(std::move(field));
  }

  std::uint64_t number(std::string_view text) const {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value == 0 ||
        value > kMostElements) {
      fail("\"" + std::string(text) + "\", expected a number of elements");
    }
    return value;
  }

  /// None of a constant.
  std::optional<Ros2Field> field_of(std::string_view line, std::size_t depth) {
    std::string_view type = taken(line, [](char c) { return is_space(c) || c == '#'; });
    line = without_spaces(line);
    const std::string_view name = taken(line, [](char c) { return !is_name(c); });
    if (name.empty()) {
      fail("\"" + std::string(type.substr(0, 40)) + "\", expected a type and a name");
    }
    if (without_spaces(line).starts_with('=')) return std::nullopt;
    Ros2Field field;
    field.name = name;
    if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
      if (type.back() != ']') fail("\"" + std::string(type) + "\", expected ] at its end");
      std::string_view count = type.substr(bracket + 1, type.size() - bracket - 2);
      type = type.substr(0, bracket);
      field.list = Ros2List::sequence;
      field.count = kMostElements;
      if (count.starts_with("<=")) {
        field.count = number(count.substr(2));
      } else if (!count.empty()) {
        field.list = Ros2List::fixed;
        field.count = number(count);
      }
    }
    field.longest = kMostElements;
    if (const std::size_t bound = type.find("<="); bound != std::string_view::npos) {
      field.longest = number(type.substr(bound + 2));
      type = type.substr(0, bound);
      if (type != "string" && type != "wstring") fail("<= is expected of string and wstring alone");
    }
    set_type(field, type, depth);
    return field;
  }

  void set_type(Ros2Field& field, std::string_view type, std::size_t depth) {
    if (ros1_ && (type == "time" || type == "duration")) {
      type = type == "time" ? kRos1Time : kRos1Duration;
    }
    for (const auto& [name, plain] : kPlain) {
      if (type != name) continue;
      field.type = ros1_ && type == "byte" ? Ros2Type::int8 : plain;
      layout_.wide = layout_.wide || plain == Ros2Type::wide_text;
      return;
    }
    const auto odd = [](char c) { return !is_name(c) && c != '/'; };
    if (type.empty() || std::any_of(type.begin(), type.end(), odd)) {
      fail("\"" + std::string(type.substr(0, 40)) + "\", expected a type");
    }
    field.type = Ros2Type::group;
    field.group = group(ros2_type_name(type), depth + 1);
  }

  std::map<std::string, Section> sections_;
  bool ros1_;
  const MessageDefinitions* given_;
  std::map<std::string, std::size_t> done_;  // where in the layout; depth is 0 while it is filled
  std::vector<std::string> package_;         // of the types that are being read
  std::size_t line_ = 0;
  std::string_view of_ = kOfBag;  // Section::of
  Ros2Layout layout_;
};

}  // namespace

std::size_t size_of(Ros2Type type) {
  switch (type) {
    case Ros2Type::boolean:
    case Ros2Type::int8:
    case Ros2Type::uint8:
      return 1;
    case Ros2Type::int16:
    case Ros2Type::uint16:
      return 2;
    case Ros2Type::int32:
    case Ros2Type::uint32:
    case Ros2Type::float32:
      return 4;
    case Ros2Type::int64:
    case Ros2Type::uint64:
    case Ros2Type::float64:
      return 8;
    default:
      return 0;
  }
}

std::string ros2_type_name(std::string_view type) {
  const std::size_t first = type.find('/');
  if (first == std::string_view::npos || type.substr(first, 5) != "/msg/") {
    return std::string(type);
  }
  return std::string(type.substr(0, first)) + std::string(type.substr(first + 4));
}

Ros2Layout parse_ros2_definition(std::string_view type, std::string_view text,
                                 const MessageDefinitions* given) {
  return Parser(type, text, false, given).layout(type);
}

Ros2Layout parse_ros1_definition(std::string_view type, std::string_view text) {
  return Parser(type, text, true, nullptr).layout(type);
}

}  // namespace trussmap::logs
