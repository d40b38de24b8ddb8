// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/wpilog_struct.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>

namespace trussmap::logs {
namespace {

constexpr std::string_view kStructBlanks = " \t\r\n";
constexpr std::uint64_t kLargest = std::uint64_t{1} << 24U;  // bytes of a struct
constexpr int kDeepestStruct = 32;

struct Known {
  const char* name;
  const char* schema;
};

// As WPILib's classes state them (wpimath, geometry/struct and kinematics/struct).
constexpr Known kKnown[] = {{"ChassisSpeeds", "double vx;double vy;double omega"},
                            {"DifferentialDriveWheelPositions", "double left;double right"},
                            {"DifferentialDriveWheelSpeeds", "double left;double right"},
                            {"Pose2d", "Translation2d translation;Rotation2d rotation"},
                            {"Pose3d", "Translation3d translation;Rotation3d rotation"},
                            {"Quaternion", "double w;double x;double y;double z"},
                            {"Rotation2d", "double value"},
                            {"Rotation3d", "Quaternion q"},
                            {"SwerveModulePosition", "double distance;Rotation2d angle"},
                            {"SwerveModuleState", "double speed;Rotation2d angle"},
                            {"Transform2d", "Translation2d translation;Rotation2d rotation"},
                            {"Transform3d", "Translation3d translation;Rotation3d rotation"},
                            {"Translation2d", "double x;double y"},
                            {"Translation3d", "double x;double y;double z"},
                            {"Twist2d", "double dx;double dy;double dtheta"}};

struct PlainMember {
  const char* name;
  StructKind kind;
  std::uint64_t size;
};

constexpr PlainMember kPlainMembers[] = {
    {"bool", StructKind::boolean, 1},   {"char", StructKind::character, 1},
    {"int8", StructKind::whole, 1},     {"int16", StructKind::whole, 2},
    {"int32", StructKind::whole, 4},    {"int64", StructKind::whole, 8},
    {"uint8", StructKind::natural, 1},  {"uint16", StructKind::natural, 2},
    {"uint32", StructKind::natural, 4}, {"uint64", StructKind::natural, 8},
    {"float", StructKind::real, 4},     {"float32", StructKind::real, 4},
    {"double", StructKind::real, 8},    {"float64", StructKind::real, 8}};

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kStructBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kStructBlanks) + 1);
}

/// Takes the text up to one of these characters.
std::string_view take_until(std::string_view& text, std::string_view ends) {
  const std::string_view found = text.substr(0, text.find_first_of(ends));
  text = trimmed(text.substr(found.size()));
  return found;
}

std::optional<std::uint64_t> count_in(std::string_view text) {
  text = trimmed(text);
  std::uint64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A declaration's parts.
struct Declaration {
  std::string_view type;
  std::string_view name;
  std::optional<std::uint64_t> count;
  std::optional<std::uint64_t> bits;
};

std::optional<Declaration> parsed(std::string_view text) {
  constexpr std::string_view kEnum = "enum";
  if (text.starts_with(kEnum) && trimmed(text.substr(kEnum.size())).starts_with('{')) {
    text = trimmed(text.substr(kEnum.size()));
  }
  if (text.starts_with('{')) {
    const std::size_t end = text.find('}');
    if (end == std::string_view::npos) return std::nullopt;
    text = trimmed(text.substr(end + 1));
  }
  Declaration found;
  found.type = take_until(text, kStructBlanks);
  found.name = take_until(text, " \t\r\n[:");
  if (found.type.empty() || found.name.empty()) return std::nullopt;
  if (text.empty()) return found;
  if (text.front() == ':') {
    found.bits = count_in(text.substr(1));
    return found.bits ? std::optional(found) : std::nullopt;
  }
  if (text.front() != '[' || text.back() != ']') return std::nullopt;
  found.count = count_in(text.substr(1, text.size() - 2));
  return found.count ? std::optional(found) : std::nullopt;
}

/// Where the bit-field lies: in the integer of the one before, if it fits.
bool place_bits(StructMember& member, std::uint64_t bits, const StructType& type) {
  const bool whole = member.kind == StructKind::boolean || member.kind == StructKind::whole ||
                     member.kind == StructKind::natural;
  const std::uint64_t most = member.kind == StructKind::boolean ? 1 : 8 * member.size;
  if (!whole || bits < 1 || bits > most) return false;
  member.bits = static_cast<unsigned>(bits);
  member.offset = type.size;
  if (type.members.empty() || type.members.back().bits == 0) return true;
  const StructMember& before = type.members.back();
  const bool same = before.size == member.size || member.kind == StructKind::boolean;
  const std::uint64_t used = before.shift + before.bits;
  if (same && used + bits <= 8 * before.size) {
    member.size = before.size;
    member.offset = before.offset;
    member.shift = static_cast<unsigned>(used);
  }
  return true;
}

std::uint64_t raw_bits(std::string_view bytes) {
  std::uint64_t raw = 0;
  for (std::size_t k = bytes.size(); k-- > 0;) {
    raw = raw << 8U | static_cast<unsigned char>(bytes[k]);
  }
  return raw;
}

/// The lowest bits as a number with a sign.
std::int64_t with_sign(std::uint64_t raw, unsigned bits) {
  const unsigned above = 64 - bits;
  return static_cast<std::int64_t>(raw << above) >> above;
}

void add_element(const StructMember& member, std::string_view bytes, std::string_view name,
                 std::size_t elements, FieldTree& tree) {
  if (member.kind == StructKind::group) {
    decode_struct(*member.type, bytes, name, elements, tree);
    return;
  }
  std::uint64_t raw = raw_bits(bytes) >> member.shift;
  const unsigned bits = member.bits != 0 ? member.bits : static_cast<unsigned>(8 * member.size);
  if (bits < 64) raw &= (std::uint64_t{1} << bits) - 1;
  switch (member.kind) {
    case StructKind::boolean:
      tree.add_integer(name, raw != 0 ? 1 : 0);
      break;
    case StructKind::whole:
      tree.add_integer(name, with_sign(raw, bits));
      break;
    case StructKind::natural:
      tree.add_unsigned(name, raw);
      break;
    case StructKind::real:
      tree.add_number(name, member.size == 4
                                ? double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))}
                                : std::bit_cast<double>(raw));
      break;
    case StructKind::character:
    case StructKind::group:
      break;
  }
}

}  // namespace

bool StructSchemas::add(const std::string& name, std::string_view text) {
  const auto [place, fresh] = stated_.try_emplace(name, text);
  if (!fresh && place->second == text) return false;
  place->second = text;
  types_.clear();
  return true;
}

StructSchemas::Found StructSchemas::find(const std::string& name) {
  return made(name, 0);
}

StructSchemas::Found StructSchemas::made(const std::string& name, int depth) {
  if (const auto place = types_.find(name); place != types_.end()) return {place->second, ""};
  if (depth > kDeepestStruct) return {nullptr, "its structs are nested too deeply"};
  std::string_view text;
  if (const auto place = stated_.find(name); place != stated_.end()) {
    text = place->second;
  } else {
    const auto* const known = std::find_if(std::begin(kKnown), std::end(kKnown),
                                           [&name](const Known& one) { return name == one.name; });
    if (known == std::end(kKnown)) {
      return {nullptr, "its schema struct:" + name + " is not in the log"};
    }
    text = known->schema;
  }
  const auto type = std::make_shared<StructType>();
  type->fields = 1;
  while (!text.empty()) {
    const std::string_view declared = trimmed(text.substr(0, text.find(';')));
    text.remove_prefix(std::min(text.find(';'), text.size() - 1) + 1);
    if (declared.empty()) continue;
    if (std::string problem = add_member(*type, declared, depth); !problem.empty()) {
      if (!problem.starts_with("its ")) problem.insert(0, "its schema struct:" + name + " ");
      return {nullptr, problem};
    }
  }
  if (type->size == 0) return {nullptr, "its schema struct:" + name + " has no members"};
  types_[name] = type;
  return {type, ""};
}

/// What is wrong with the declaration; empty: nothing.
std::string StructSchemas::add_member(StructType& type, std::string_view declared, int depth) {
  const std::string wrong = "has the member \"" + std::string(declared.substr(0, 60)) + "\", ";
  const std::optional<Declaration> parts = parsed(declared);
  if (!parts) return wrong + "expected TYPE NAME, NAME[SIZE] or NAME:BITS";
  StructMember member;
  member.name = parts->name;
  member.list = parts->count.has_value();
  member.count = parts->count.value_or(1);
  member.offset = type.size;
  std::uint64_t fields = 1;
  const auto* const plain =
      std::find_if(std::begin(kPlainMembers), std::end(kPlainMembers),
                   [&parts](const PlainMember& one) { return parts->type == one.name; });
  if (plain != std::end(kPlainMembers)) {
    member.kind = plain->kind;
    member.size = plain->size;
  } else {
    const Found nested = made(std::string(parts->type), depth + 1);
    if (nested.type == nullptr) return nested.problem;
    member.kind = StructKind::group;
    member.type = nested.type;
    member.size = nested.type->size;
    fields = nested.type->fields;
  }
  if (parts->bits && !place_bits(member, *parts->bits, type)) {
    return wrong + "expected an integer and no more bits than it has";
  }
  if (member.count > kLargest || member.offset + member.size * member.count > kLargest ||
      type.fields + 1 + fields * member.count > kMostFields) {
    return "is larger than 16 MiB or a million fields";
  }
  type.size = std::max(type.size, member.offset + member.size * member.count);
  type.fields += fields * member.count + (member.list ? 1 : 0);
  type.members.push_back(std::move(member));
  return {};
}

void decode_struct(const StructType& type, std::string_view bytes, std::string_view name,
                   std::size_t elements, FieldTree& tree) {
  const std::size_t group = tree.open_group(name);
  for (const StructMember& member : type.members) {
    const std::string_view own = bytes.substr(static_cast<std::size_t>(member.offset),
                                              static_cast<std::size_t>(member.size * member.count));
    if (member.kind == StructKind::character) {
      constexpr std::string_view kZero("\0", 1);
      tree.add_text(member.name, own.substr(0, own.find_last_not_of(kZero) + 1));
      continue;
    }
    if (!member.list) {
      add_element(member, own, member.name, elements, tree);
      continue;
    }
    const auto count = static_cast<std::size_t>(member.count);
    const auto size = static_cast<std::size_t>(member.size);
    const std::size_t list = tree.open_list(member.name, count);
    const std::size_t kept = member.kind == StructKind::group ? count : std::min(count, elements);
    for (std::size_t k = 0; k < kept; ++k) {
      add_element(member, own.substr(k * size, size), "", elements, tree);
    }
    tree.close(list);
  }
  tree.close(group);
}

}  // namespace trussmap::logs
