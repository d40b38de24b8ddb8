// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// ROS 2 messages as bytes: CDR, the encoding of DDS (XCDR1, little-endian).
//
//   00 01 00 00    encapsulation: little-endian
//   numbers        at multiples of their size, counted from behind the encapsulation
//   string         uint32 length with the closing 0, the characters, 0
//   sequence       uint32 count, the elements; an array of fixed length: the elements
//
// Source: OMG DDS-XTypes 1.3, 7.4; DDSI-RTPS 2.5, 10.
#pragma once

#include "logs/little_endian.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

class CdrWriter {
 public:
  template <typename T>
  CdrWriter& number(T value) {
    const std::size_t over = (bytes_.size() - kEncapsulation) % sizeof(T);
    if (over != 0) bytes_.append(sizeof(T) - over, '\0');
    put_little(bytes_, value);
    return *this;
  }

  CdrWriter& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value;
    bytes_ += '\0';
    return *this;
  }

  CdrWriter& count(std::size_t elements) { return number(static_cast<std::uint32_t>(elements)); }

  template <typename T, std::size_t N>
  CdrWriter& numbers(const std::array<T, N>& values) {
    for (const T& one : values) number(one);
    return *this;
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;
  std::string bytes_ = std::string("\0\1\0\0", kEncapsulation);
};

}  // namespace trussmap::logs
