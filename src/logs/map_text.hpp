// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map.toml as text, line by line, with comments beside.
#pragma once

#include "io/toml_text.hpp"

#include <string>

#include <fmt/format.h>

namespace trussmap::logs {

class MapText {
 public:
  void comment(const std::string& text) { text_ += "# " + one_line(text) + "\n"; }
  void blank() { text_ += "\n"; }
  void table(const std::string& name, const std::string& why = "") { line("[" + name + "]", why); }
  void list(const std::string& name, const std::string& why = "") { line("[[" + name + "]]", why); }
  void text(const std::string& key, const std::string& value, const std::string& why = "") {
    line(key + " = " + io::toml_string(value), why);
  }
  void number(const std::string& key, double value, const std::string& why = "") {
    line(fmt::format("{} = {}", key, value), why);
  }
  void line(const std::string& text, const std::string& why = "") {
    text_ += text;
    if (!why.empty()) text_ += "   # " + one_line(why);
    text_ += '\n';
  }
  void append(const MapText& other) { text_ += other.text_; }
  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  /// A comment that names a topic or a file ends with its line, whatever they are called.
  static std::string one_line(std::string text) {
    for (char& c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20U || byte == 0x7FU) c = '?';
    }
    return io::valid_utf8(text);
  }

  std::string text_;
};

/// What stands beside a figure that nothing in a log tells.
inline constexpr const char* kState = "STATE IT: nothing in the log tells";

}  // namespace trussmap::logs
