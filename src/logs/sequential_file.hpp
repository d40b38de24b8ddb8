// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A file read once from begin to end, with the checksum (CRC-32) of all that was read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace trussmap::logs {

[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

class SequentialFile {
 public:
  /// Throws InputError, with `shown` for the name of the file.
  SequentialFile(const std::filesystem::path& file, std::string shown);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t at() const { return at_; }
  /// Of all before the last read.
  [[nodiscard]] std::uint32_t crc_before() const { return crc_before_; }

  /// The next bytes, less where the file ends; valid until the next call.
  [[nodiscard]] std::string_view read(std::uint64_t count);
  /// Bytes passed over, less than `count` where the file ends.
  [[nodiscard]] std::uint64_t skip(std::uint64_t count);
  /// Whether all from here to the end is zero; what is read is read.
  [[nodiscard]] bool zeros_to_end();
  /// None of a pipe.
  [[nodiscard]] std::optional<std::uint64_t> size() const { return size_; }
  /// Bytes anywhere in the file, less where it ends; what is read next is the same as without.
  [[nodiscard]] std::string look(std::uint64_t at, std::size_t count) const;
  /// From here on no checksum is made: crc_before() means nothing.
  void without_checksum() { checked_ = false; }

 private:
  std::filesystem::path path_;
  std::string name_;
  std::ifstream stream_;
  std::optional<std::uint64_t> size_;
  std::string buffer_;  // as large as it ever was
  std::uint64_t at_ = 0;
  std::uint64_t most_ = 0;  // bytes that are read
  bool checked_ = true;
  std::uint32_t crc_ = 0;
  std::uint32_t crc_before_ = 0;
};

}  // namespace trussmap::logs
