// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The bytes of a file from begin to end, of which only those in use are in memory.
//
//   FileWindow window(file);                      ... already read | in memory | not yet ...
//   while (!window.peek(1).empty()) {                              ^ offset()
//     const std::string_view head = window.peek(12);   // fewer at the file's end
//     window.skip(head.size());
//   }
//
// Memory: what is peeked at, and a block; of an .xz all that it becomes (limited as by read_file).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

namespace trussmap::logs {

class FileWindow {
 public:
  /// Throws InputError where the file cannot be opened.
  explicit FileWindow(const std::filesystem::path& file);

  /// The bytes from here on: at least `count`, or all that are left. Valid until the next call.
  [[nodiscard]] std::string_view peek(std::size_t count);
  /// Goes on by `count` bytes; returns fewer where the file ends before.
  std::uint64_t skip(std::uint64_t count);
  /// Bytes of the (decompressed) file before this place.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }

 private:
  bool fill();

  std::string name_;
  std::ifstream stream_;  // closed of an .xz
  std::string buffer_;
  std::size_t at_ = 0;  // in the buffer
  std::uint64_t offset_ = 0;
  std::uint64_t most_ = std::numeric_limits<std::uint64_t>::max();  // bytes that are read
};

}  // namespace trussmap::logs
