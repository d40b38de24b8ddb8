// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/sequential_file.hpp"

#include "files/present.hpp"
#include "io/read_limits.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <system_error>

#include <lzma.h>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kStep = std::uint64_t{1} << 20U;  // bytes believed in of a pipe

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  return lzma_crc32(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), before);
}

SequentialFile::SequentialFile(const fs::path& file, std::string shown)
    : path_(file), name_(std::move(shown)) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw InputError(name_, 0, "is a folder, expected a file");
  stream_.open(file, std::ios::binary);
  if (!stream_) throw files::unreadable(name_);
  most_ = io::most_read(file);
  if (fs::is_regular_file(file, ignored)) {
    const std::uintmax_t size = fs::file_size(file, ignored);
    if (!ignored) size_ = size;
  }
}

std::string_view SequentialFile::read(std::uint64_t count) {
  std::uint64_t there = 0;
  const std::uint64_t first = size_ ? count : std::min(count, kStep);
  const std::uint64_t left = size_ ? *size_ - std::min(*size_, at_) : first;
  std::uint64_t wanted = std::min(first, left);
  while (wanted > there) {
    if (buffer_.size() < wanted) buffer_.resize(static_cast<std::size_t>(wanted));
    stream_.read(buffer_.data() + there, static_cast<std::streamsize>(wanted - there));
    if (stream_.bad()) throw InputError(name_, 0, "cannot be read to its end");
    there += static_cast<std::uint64_t>(stream_.gcount());
    if (!stream_) break;
    if (!size_) wanted = std::min(count, 2 * wanted);
  }
  const std::string_view found =
      std::string_view(buffer_).substr(0, static_cast<std::size_t>(there));
  crc_before_ = crc_;
  if (checked_) crc_ = crc32(found, crc_);
  at_ += there;
  if (at_ > most_) throw io::too_long(name_, most_);
  return found;
}

std::uint64_t SequentialFile::skip(std::uint64_t count) {
  std::uint64_t passed = 0;
  while (passed < count) {
    const std::uint64_t step = std::min(kStep, count - passed);
    const std::uint64_t found = read(step).size();
    passed += found;
    if (found < step) break;
  }
  return passed;
}

bool SequentialFile::zeros_to_end() {
  while (true) {
    const std::string_view found = read(kStep);
    if (found.find_first_not_of('\0') != std::string_view::npos) return false;
    if (found.size() < kStep) return true;
  }
}

std::string SequentialFile::look(std::uint64_t at, std::size_t count) const {
  std::ifstream again(path_, std::ios::binary);
  again.seekg(static_cast<std::streamoff>(at));
  std::string found(count, '\0');
  again.read(found.data(), static_cast<std::streamsize>(found.size()));
  found.resize(static_cast<std::size_t>(again.gcount()));
  return found;
}

}  // namespace trussmap::logs
