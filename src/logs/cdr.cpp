// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/cdr.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace trussmap::logs {
namespace {

constexpr std::size_t kEncapsulation = 4;  // bytes
constexpr std::size_t kPadding = 3;        // that may follow the last field

constexpr std::uint32_t kLastCharacter = 0x10FFFFU;

void add_utf8(std::string& text, std::uint32_t code) {
  const auto add = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80U) {
    add(code);
  } else if (code < 0x800U) {
    add(0xC0U | (code >> 6U));
    add(0x80U | (code & 0x3FU));
  } else if (code < 0x10000U) {
    add(0xE0U | (code >> 12U));
    add(0x80U | ((code >> 6U) & 0x3FU));
    add(0x80U | (code & 0x3FU));
  } else {
    add(0xF0U | (code >> 18U));
    add(0x80U | ((code >> 12U) & 0x3FU));
    add(0x80U | ((code >> 6U) & 0x3FU));
    add(0x80U | (code & 0x3FU));
  }
}

bool is_high(std::uint32_t code) {
  return code >= 0xD800U && code < 0xDC00U;
}
bool is_low(std::uint32_t code) {
  return code >= 0xDC00U && code < 0xE000U;
}

/// How the bytes of a message are laid out.
struct Wire {
  bool big = false;      // most significant byte first
  std::size_t wide = 2;  // bytes of a wide character
  bool ros1 = false;     // without gaps, closing zeros and a byte for what is empty
};

class Decoder {
 public:
  Decoder(std::string_view body, const Wire& wire, const Ros2Layout& layout, std::size_t elements,
          FieldTree& tree)
      : body_(body),
        swap_(wire.big != (std::endian::native == std::endian::big)),
        wide_(wire.wide),
        ros1_(wire.ros1),
        layout_(&layout),
        elements_(elements),
        tree_(&tree) {}

  void decode() {
    // Senders agree on a byte of a message without fields, but not on whether it is there.
    if (layout_->groups[0].fields.empty() && body_.empty()) {
      tree_->close(tree_->open_group({}));
      return;
    }
    group(layout_->groups[0], {}, true);
    if (body_.size() - at_ > (ros1_ ? 0 : kPadding)) {
      throw CdrError("has " + std::to_string(body_.size() - at_) +
                     " bytes after its last field, expected the fields of " +
                     layout_->groups[0].type + " alone");
    }
  }

 private:
  void need(std::uint64_t count, const std::string& name) const {
    if (count <= body_.size() - at_) return;
    throw CdrError("needs " + std::to_string(count) + " bytes for " + name + ", " +
                   std::to_string(body_.size() - at_) + " are left");
  }

  void align(std::size_t size, const std::string& name) {
    const std::size_t over = at_ % size;
    if (over == 0 || ros1_) return;
    need(size - over, name);
    at_ += size - over;
  }

  template <typename T>
  T number_at(std::size_t at) const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), body_.data() + at, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  std::uint32_t length(const std::string& name) {
    align(sizeof(std::uint32_t), name);
    need(sizeof(std::uint32_t), name);
    const auto value = number_at<std::uint32_t>(at_);
    at_ += sizeof(std::uint32_t);
    return value;
  }

  void group(const Ros2Group& one, std::string_view name, bool kept) {
    need(one.least, one.type);
    const std::size_t opened = kept ? tree_->open_group(name) : 0;
    if (one.fields.empty() && !ros1_) ++at_;
    for (const Ros2Field& field : one.fields) {
      if (field.list == Ros2List::none) {
        value(field, field.name, kept);
      } else {
        list(field, kept);
      }
    }
    if (kept) tree_->close(opened);
  }

  void value(const Ros2Field& field, std::string_view name, bool kept) {
    switch (field.type) {
      case Ros2Type::group:
        group(layout_->groups[field.group], name, kept);
        break;
      case Ros2Type::text:
        text(field, name, kept);
        break;
      case Ros2Type::wide_text:
        wide_text(field, name, kept);
        break;
      default: {
        const std::size_t size = size_of(field.type);
        align(size, field.name);
        need(size, field.name);
        if (kept) number(field.type, at_, name);
        at_ += size;
      }
    }
  }

  void number(Ros2Type type, std::size_t at, std::string_view name) {
    switch (type) {
      case Ros2Type::boolean:
        return tree_->add_integer(name, number_at<std::uint8_t>(at) != 0 ? 1 : 0);
      case Ros2Type::int8:
        return tree_->add_integer(name, number_at<std::int8_t>(at));
      case Ros2Type::uint8:
        return tree_->add_integer(name, number_at<std::uint8_t>(at));
      case Ros2Type::int16:
        return tree_->add_integer(name, number_at<std::int16_t>(at));
      case Ros2Type::uint16:
        return tree_->add_integer(name, number_at<std::uint16_t>(at));
      case Ros2Type::int32:
        return tree_->add_integer(name, number_at<std::int32_t>(at));
      case Ros2Type::uint32:
        return tree_->add_integer(name, number_at<std::uint32_t>(at));
      case Ros2Type::int64:
        return tree_->add_integer(name, number_at<std::int64_t>(at));
      case Ros2Type::uint64:
        return tree_->add_unsigned(name, number_at<std::uint64_t>(at));
      case Ros2Type::float32:
        return tree_->add_number(name, number_at<float>(at));
      default:
        return tree_->add_number(name, number_at<double>(at));
    }
  }

  void text(const Ros2Field& field, std::string_view name, bool kept) {
    const std::uint32_t bytes = length(field.name);
    need(bytes, field.name);
    std::string_view found = body_.substr(at_, bytes);
    if (found.ends_with('\0') && !ros1_) found.remove_suffix(1);
    check_longest(field, found.size());
    if (kept) tree_->add_text(name, found);
    at_ += bytes;
  }

  void wide_text(const Ros2Field& field, std::string_view name, bool kept) {
    const std::uint32_t count = length(field.name);
    check_longest(field, count);
    need(std::uint64_t{count} * wide_, field.name);
    std::string found;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t one = code(k);
      const bool none = wide_ == 4 && (one > kLastCharacter || is_high(one) || is_low(one));
      if (one == 0 || none) throw CdrError("has no text in " + field.name);
      if (kept) found += character(k, count);
    }
    if (kept) tree_->add_text(name, tree_->keep(std::move(found)));
    at_ += std::size_t{count} * wide_;
  }

  std::uint32_t code(std::size_t k) const {
    const std::size_t at = at_ + k * wide_;
    return wide_ == 2 ? number_at<std::uint16_t>(at) : number_at<std::uint32_t>(at);
  }

  /// In UTF-8; of a pair of surrogates all with the first, nothing with the second.
  std::string character(std::size_t k, std::size_t count) const {
    constexpr std::uint32_t kUnknown = 0xFFFDU;
    std::uint32_t one = code(k);
    if (is_low(one) && k > 0 && is_high(code(k - 1))) return {};
    if (is_high(one) && k + 1 < count && is_low(code(k + 1))) {
      one = 0x10000U + ((one - 0xD800U) << 10U) + (code(k + 1) - 0xDC00U);
    }
    std::string result;
    add_utf8(result, is_high(one) || is_low(one) ? kUnknown : one);
    return result;
  }

  void check_longest(const Ros2Field& field, std::uint64_t characters) const {
    if (characters <= field.longest) return;
    throw CdrError("has " + std::to_string(characters) + " characters in " + field.name +
                   ", expected " + std::to_string(field.longest) + " at most");
  }

  void list(const Ros2Field& field, bool kept) {
    const std::uint64_t count =
        field.list == Ros2List::fixed ? field.count : std::uint64_t{length(field.name)};
    if (count > field.count) {
      throw CdrError("has " + std::to_string(count) + " elements in " + field.name + ", expected " +
                     std::to_string(field.count) + " at most");
    }
    const std::size_t opened =
        kept ? tree_->open_list(field.name, static_cast<std::size_t>(count)) : 0;
    if (const std::size_t size = size_of(field.type); size > 0) {
      numbers(field, count, size, kept);
    } else {
      const bool group = field.type == Ros2Type::group;
      const std::uint64_t least =
          group ? layout_->groups[field.group].least : sizeof(std::uint32_t);
      const auto keeps = [&] { return kept && tree_->size() < kMostMessageFields; };
      if (least == 0) {  // elements without a byte: as many as are kept, whatever their number
        for (std::uint64_t k = 0; k < count && keeps(); ++k) value(field, {}, true);
      } else {
        // Fixed sizes multiply to at most what the layout was limited to.
        if (count > (body_.size() - at_) / least) need(body_.size() - at_ + 1, field.name);
        for (std::uint64_t k = 0; k < count; ++k) value(field, {}, keeps());
      }
    }
    if (kept) tree_->close(opened);
  }

  void numbers(const Ros2Field& field, std::uint64_t count, std::size_t size, bool kept) {
    if (count == 0) return;  // not aligned either
    align(size, field.name);
    need(count * size, field.name);
    const std::size_t full = kMostMessageFields - std::min(kMostMessageFields, tree_->size());
    const std::size_t first =
        kept ? static_cast<std::size_t>(std::min<std::uint64_t>({count, elements_, full})) : 0;
    for (std::size_t k = 0; k < first; ++k) number(field.type, at_ + k * size, {});
    at_ += static_cast<std::size_t>(count) * size;
  }

  std::string_view body_;
  bool swap_;
  std::size_t wide_;
  bool ros1_;
  const Ros2Layout* layout_;
  std::size_t elements_;
  FieldTree* tree_;
  std::size_t at_ = 0;
};

bool same(const FieldRef& a, const FieldRef& b) {
  const std::vector<FieldRef> of_a = a.children();
  const std::vector<FieldRef> of_b = b.children();
  return a.kind() == b.kind() && a.field().text == b.field().text &&
         a.field().length == b.field().length && a.field().integer == b.field().integer &&
         std::bit_cast<std::uint64_t>(a.number()) == std::bit_cast<std::uint64_t>(b.number()) &&
         std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), same);
}

bool big_endian(std::string_view message) {
  if (message.size() < kEncapsulation) {
    throw CdrError("has " + std::to_string(message.size()) + " bytes, expected 4 or more");
  }
  const auto first = static_cast<unsigned char>(message[0]);
  const auto second = static_cast<unsigned char>(message[1]);
  if (first == 0 && second <= 1) return second == 0;
  const bool later = first == 0 && second <= 0x0B;
  throw CdrError(std::string("is encoded in ") + (later ? "another kind of CDR (" : "no CDR (") +
                 std::to_string(first) + ", " + std::to_string(second) +
                 "), expected plain CDR (0, 0 or 0, 1)");
}

}  // namespace

void decode_cdr(std::string_view message, const Ros2Layout& layout, std::size_t elements,
                FieldTree& tree) {
  const bool big = big_endian(message);
  const std::string_view body = message.substr(kEncapsulation);
  const auto decode = [&](std::size_t wide) {
    tree.clear();
    Decoder(body, {big, wide, false}, layout, elements, tree).decode();
  };
  if (!layout.wide) return decode(2);
  FieldTree other;
  bool four = true;
  try {
    Decoder(body, {big, 4, false}, layout, elements, other).decode();
  } catch (const CdrError&) {
    four = false;
  }
  try {
    decode(2);
  } catch (const CdrError&) {
    if (!four) throw;
    return decode(4);
  }
  if (four && !same(tree.root(), other.root())) {
    throw CdrError("has wide texts whose characters may have 2 bytes or 4");
  }
}

void decode_ros1(std::string_view message, const Ros2Layout& layout, std::size_t elements,
                 FieldTree& tree) {
  tree.clear();
  Decoder(message, {false, 2, true}, layout, elements, tree).decode();
}

}  // namespace trussmap::logs
