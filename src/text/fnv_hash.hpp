// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// FNV-1a, 64 bits: tells texts apart that nobody made alike on purpose.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace trussmap::text {

class FnvHash {
 public:
  void take(std::string_view text) {
    for (const char c : text) state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  /// 16, hexadecimal.
  [[nodiscard]] std::string digits() const {
    std::string result;
    for (int shift = 60; shift >= 0; shift -= 4) {
      result += "0123456789abcdef"[(state_ >> shift) & 15U];
    }
    return result;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

}  // namespace trussmap::text
