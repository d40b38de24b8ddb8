// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/wpilog_type.hpp"

#include <algorithm>
#include <string_view>

namespace trussmap::logs {
namespace {

struct PlainType {
  const char* name;
  WpilogContent content;
  std::size_t size;  // bytes of an element
};

constexpr PlainType kPlainTypes[] = {
    {"boolean", WpilogContent::boolean, 1}, {"int64", WpilogContent::whole, 8},
    {"float", WpilogContent::single, 4},    {"double", WpilogContent::real, 8},
    {"string", WpilogContent::text, 0},     {"json", WpilogContent::text, 0}};

void decode_texts(ByteReader& payload, FieldTree& tree) {
  constexpr std::size_t kLength = 4;
  const auto count = payload.number<std::uint32_t>();
  if (count > payload.left() / kLength || count > kMostFields) {
    payload.fail("a list of " + std::to_string(count) + " texts in " +
                 std::to_string(payload.left()) + " bytes");
  }
  const std::size_t list = tree.open_list("", count);
  for (std::uint32_t k = 0; k < count; ++k) {
    tree.add_text("", payload.take(payload.number<std::uint32_t>()));
  }
  tree.close(list);
  if (!payload.done()) {
    payload.fail("string[] with " + std::to_string(payload.left()) + " bytes too many");
  }
}

void decode_one(const WpilogType& type, ByteReader& payload, std::size_t elements,
                FieldTree& tree) {
  switch (type.content) {
    case WpilogContent::boolean:
      tree.add_integer("", payload.number<std::uint8_t>() != 0 ? 1 : 0);
      break;
    case WpilogContent::whole:
      tree.add_integer("", payload.number<std::int64_t>());
      break;
    case WpilogContent::single:
      tree.add_number("", double{payload.number<float>()});
      break;
    case WpilogContent::real:
      tree.add_number("", payload.number<double>());
      break;
    case WpilogContent::structure:
      decode_struct(*type.type, payload.take(type.type->size), "", elements, tree);
      break;
    case WpilogContent::text:
      tree.add_text("", payload.take(payload.left()));
      break;
    case WpilogContent::schema:
    case WpilogContent::unread:
      break;
  }
}

}  // namespace

WpilogType wpilog_type(const std::string& entry, const std::string& type) {
  constexpr std::string_view kStruct = "struct:";
  constexpr std::string_view kSchema = "/.schema/struct:";
  WpilogType found;
  found.name = type;
  const std::size_t schema = entry.rfind(kSchema);
  if (type == "structschema" && schema != std::string::npos) {
    found.content = WpilogContent::schema;
    found.structure = entry.substr(schema + kSchema.size());
    return found;
  }
  found.list = type.ends_with("[]");
  const std::string element = found.list ? type.substr(0, type.size() - 2) : type;
  if (element.starts_with(kStruct)) {
    found.content = WpilogContent::structure;
    found.structure = element.substr(kStruct.size());
    return found;
  }
  for (const PlainType& one : kPlainTypes) {
    if (element != one.name || (found.list && element == "json")) continue;
    found.content = one.content;
    found.size = one.size;
    return found;
  }
  found.unread = type.starts_with("proto:")
                     ? "protobuf"
                     : "its type \"" + type.substr(0, 60) + "\" is none that can be read";
  return found;
}

void decode_wpilog(const WpilogType& type, ByteReader& payload, std::size_t elements,
                   FieldTree& tree) {
  if (type.content == WpilogContent::text) {
    if (type.list) {
      decode_texts(payload, tree);
    } else {
      decode_one(type, payload, elements, tree);
    }
    return;
  }
  const auto size = type.type != nullptr ? static_cast<std::size_t>(type.type->size) : type.size;
  const std::size_t bytes = payload.left();
  if (type.list ? bytes % size != 0 : bytes != size) {
    payload.fail(type.name + " of " + std::to_string(bytes) + " bytes, expected " +
                 (type.list ? "a multiple of " : "") + std::to_string(size));
  }
  if (!type.list) {
    decode_one(type, payload, elements, tree);
    return;
  }
  const std::size_t count = bytes / size;
  std::size_t kept = std::min(count, elements);
  if (type.content == WpilogContent::structure) {
    if (count * type.type->fields > kMostFields) payload.fail("a list of over a million fields");
    kept = count;
  }
  const std::size_t list = tree.open_list("", count);
  for (std::size_t k = 0; k < kept; ++k) decode_one(type, payload, elements, tree);
  tree.close(list);
}

}  // namespace trussmap::logs
