// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers out of bytes, never beyond their end.
#pragma once

#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace trussmap::logs {

/// What a file says of itself, as it can stand in a line of ours: without control characters, and
/// not endless.
[[nodiscard]] inline std::string in_a_line(std::string_view text) {
  constexpr std::size_t kLongest = 500;  // bytes
  std::string line(text.substr(0, kLongest));
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) c = '?';
  }
  return line;
}

/// Throws InputError "FILE: at byte N: what".
[[noreturn]] inline void fail_at(const std::string& file, std::uint64_t byte,
                                 const std::string& what) {
  throw InputError(file, 0, "at byte " + std::to_string(byte) + ": " + in_a_line(what));
}

/// Bytes of a file or of what was decompressed from it. Throws InputError where they end too soon,
/// with the offset in the file of `begin` plus that within the bytes (of bytes that were
/// decompressed: of where they lie in the file, alone).
class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& file, std::uint64_t begin,
             bool decompressed = false)
      : bytes_(bytes), file_(&file), begin_(begin), decompressed_(decompressed) {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] bool done() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::uint64_t offset() const { return decompressed_ ? begin_ : begin_ + at_; }
  void big_endian(bool big) { big_ = big; }

  [[noreturn]] void fail(const std::string& what) const { fail_at(*file_, offset(), what); }

  std::string_view take(std::uint64_t count) {
    if (count > left()) {
      fail("needs " + std::to_string(count) + " more bytes, " + std::to_string(left()) +
           " are left");
    }
    const std::string_view found = bytes_.substr(at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return found;
  }
  void skip(std::uint64_t count) { static_cast<void>(take(count)); }
  /// On to a multiple of `size`, counted from `from` (CDR).
  void align(std::size_t size, std::size_t from) {
    const std::size_t over = (at_ - from) % size;
    if (over != 0) skip(size - over);
  }

  /// An integer or floating-point number of any size.
  template <typename T>
  T number() {
    std::array<char, sizeof(T)> raw{};
    const std::string_view found = take(sizeof(T));
    std::copy(found.begin(), found.end(), raw.begin());
    if (big_ != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

 private:
  std::string_view bytes_;
  const std::string* file_;
  std::uint64_t begin_;
  bool decompressed_;
  bool big_ = false;
  std::size_t at_ = 0;
};

}  // namespace trussmap::logs
