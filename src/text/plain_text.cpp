// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/plain_text.hpp"

#include "trussmap/table.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

namespace trussmap {
namespace {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  ///< 0: no UTF-8
};

CodePoint first_of(std::string_view text) {
  const auto byte = [text](std::size_t k) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80U) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < bytes) return {};
  std::uint32_t value = lead & (0x7FU >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return {};
    value = (value << 6U) | (byte(k) & 0x3FU);
  }
  const bool longer_than_needed =
      (bytes == 3 && value < 0x800U) || (bytes == 4 && value < 0x10000U);
  const bool surrogate = value >= 0xD800U && value <= 0xDFFFU;
  if (longer_than_needed || surrogate || value > 0x10FFFFU) return {};
  return {value, bytes};
}

std::string hexadecimal(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*lX", digits, static_cast<unsigned long>(value));
  return text.data();
}

bool is_command(std::uint32_t c) {
  return c < 0x20U || (c >= 0x7FU && c <= 0x9FU) || c == 0x061CU ||  // Arabic letter mark
         (c >= 0x200EU && c <= 0x200FU) ||                           // marks of direction
         (c >= 0x2028U && c <= 0x202EU) ||  // separators of lines, overrides of direction
         (c >= 0x2066U && c <= 0x2069U) ||  // isolates
         c == 0xFEFFU || c == 0xFFFEU || c == 0xFFFFU;
}

/// The text's beginning and end, whole characters.
std::string middle_left_out(std::string_view text, std::size_t before, std::size_t after) {
  const auto within = [text](std::size_t k) {
    return (static_cast<unsigned char>(text[k]) & 0xC0U) == 0x80U;
  };
  std::size_t end = text.size() - after;
  while (before > 0 && within(before)) --before;
  while (end < text.size() && within(end)) ++end;
  return std::string(text.substr(0, before)) + "..." + std::string(text.substr(end));
}

// Of a word's bytes; a path has a folder of many words, and some paths are long.
constexpr std::size_t kLongestWord = 300;
constexpr std::size_t kWordBegin = 60;
constexpr std::size_t kWordEnd = 40;
constexpr std::size_t kLongestLine = 3000;
constexpr std::size_t kLineBegin = 600;
constexpr std::size_t kLineEnd = 400;

std::string shortened_word(std::string_view word) {
  return word.size() > kLongestWord ? middle_left_out(word, kWordBegin, kWordEnd)
                                    : std::string(word);
}

/// Where a text in quotes that begins at `open` ends, npos if it does not.
std::size_t closing_quote(std::string_view line, std::size_t open) {
  for (std::size_t k = line.find('"', open + 1); k != std::string_view::npos;
       k = line.find('"', k + 1)) {
    if (k + 1 == line.size() ||
        std::string_view(" ,.;:)").find(line[k + 1]) != std::string_view::npos) {
      return k;
    }
  }
  return std::string_view::npos;
}

std::string shortened_line(std::string_view line) {
  std::string result;
  for (std::size_t k = 0; k < line.size();) {
    if (line[k] == ' ') {
      result += line[k++];
      continue;
    }
    const bool quoted = line[k] == '"';
    const std::size_t closing = quoted ? closing_quote(line, k) : std::string_view::npos;
    const std::size_t end =
        closing != std::string_view::npos ? closing + 1 : std::min(line.find(' ', k), line.size());
    result += shortened_word(line.substr(k, end - k));
    k = end;
  }
  return result.size() > kLongestLine ? middle_left_out(result, kLineBegin, kLineEnd) : result;
}

}  // namespace

std::string shortened_words(std::string_view message) {
  std::string result;
  for (std::size_t at = 0; at <= message.size();) {
    const std::size_t end = std::min(message.find('\n', at), message.size());
    result += shortened_line(message.substr(at, end - at));
    if (end < message.size()) result += '\n';
    at = end + 1;
  }
  return result;
}

std::string escaped_controls(std::string_view text, bool lines) {
  std::string result;
  while (!text.empty()) {
    const CodePoint c = first_of(text);
    if (c.bytes == 0) {
      result += "\\x" + hexadecimal(static_cast<unsigned char>(text.front()), 2);
      text.remove_prefix(1);
      continue;
    }
    if (!is_command(c.value) || (lines && c.value == '\n')) {
      result += text.substr(0, c.bytes);
    } else if (c.value < 0x100U) {
      result += "\\x" + hexadecimal(c.value, 2);
    } else {
      result += "\\u{" + hexadecimal(c.value, 4) + "}";
    }
    text.remove_prefix(c.bytes);
  }
  return result;
}

}  // namespace trussmap

namespace trussmap::text {

bool is_plain_text(std::string_view text) {
  return escaped_controls(text) == text;
}

}  // namespace trussmap::text
