// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What lz4 (frames), zstd, bzip2 and zlib have compressed, in as much memory as it truly needs:
// what a file says of sizes is believed once the bytes are there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace trussmap::logs {

/// What is wrong with compressed bytes: "the lz4 data are damaged (...)".
class DecompressError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes in memory, one piece after another.
class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Exactly `size` bytes, or at most so many; valid until the next call. Throws DecompressError.
  [[nodiscard]] std::string_view lz4(std::string_view bytes, std::uint64_t size);
  [[nodiscard]] std::string_view zstd(std::string_view bytes, std::uint64_t size);
  [[nodiscard]] std::string_view bzip2(std::string_view bytes, std::uint64_t size);
  [[nodiscard]] std::string_view zlib_of_any_size(std::string_view bytes, std::uint64_t most);
  [[nodiscard]] std::string_view zstd_of_any_size(std::string_view bytes, std::uint64_t most);

 private:
  struct Contexts;
  template <typename Step>
  std::string_view grown(std::string_view bytes, std::uint64_t most, const Step& step);
  [[nodiscard]] static std::string_view exactly(std::string_view made, std::uint64_t size);

  std::unique_ptr<Contexts> contexts_;
  std::string buffer_;  // as large as it ever was
};

[[nodiscard]] bool is_zstd(std::string_view bytes);

/// A file that ends in .zstd, without it: a temporary that is gone with this.
class DecompressedFile {
 public:
  /// Throws InputError.
  explicit DecompressedFile(const std::filesystem::path& file);
  ~DecompressedFile();
  DecompressedFile(const DecompressedFile&) = delete;
  DecompressedFile& operator=(const DecompressedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Removes it now, where it is open: it goes even if the run is killed.
  void remove() noexcept;
  /// Said where the compressed file is cut off; empty: whole.
  [[nodiscard]] const std::string& cut_off() const { return cut_off_; }

 private:
  struct Held;
  std::filesystem::path path_;
  std::unique_ptr<Held> held_;
  std::string cut_off_;
};

}  // namespace trussmap::logs
