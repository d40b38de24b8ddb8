// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/toml_text.hpp"

#include "io/csv_record.hpp"

#include <string_view>

namespace trussmap::io {

std::string valid_utf8(std::string text) {
  std::size_t from = 0;
  while (true) {
    const std::size_t bad = invalid_utf8(std::string_view(text).substr(from));
    if (bad == std::string_view::npos) return text;
    from += bad;
    text[from] = '?';
  }
}

std::string toml_string(const std::string& text) {
  std::string result = "\"";
  for (const char c : valid_utf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 0x20U || byte == 0x7FU) {
      constexpr const char* kHex = "0123456789ABCDEF";
      result += "\\u00";
      result += kHex[byte >> 4U];
      result += kHex[byte & 15U];
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace trussmap::io
