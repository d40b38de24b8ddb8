// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/file_window.hpp"

#include "files/present.hpp"
#include "io/read_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16U;

}  // namespace

FileWindow::FileWindow(const std::filesystem::path& file) : name_(file.string()) {
  files::require_file(file);
  if (file.extension() == ".xz") {
    buffer_ = read_file(file);
    return;
  }
  stream_.open(file, std::ios::binary);
  if (!stream_) throw files::unreadable(name_);
  most_ = io::most_read(file);
}

/// One more block into the buffer; false at the file's end.
bool FileWindow::fill() {
  if (!stream_.is_open() || stream_.eof()) return false;
  buffer_.erase(0, at_);
  at_ = 0;
  // What is peeked at may be long: it is not moved for every block of it.
  const std::size_t block = std::max(kBlock, buffer_.size() / 2);
  const std::size_t before = buffer_.size();
  buffer_.resize(before + block);
  stream_.read(buffer_.data() + before, static_cast<std::streamsize>(block));
  if (stream_.bad()) throw InputError(name_, 0, "cannot be read to its end");
  buffer_.resize(before + static_cast<std::size_t>(stream_.gcount()));
  if (offset_ + buffer_.size() > most_) throw io::too_long(name_, most_);
  return buffer_.size() > before;
}

std::string_view FileWindow::peek(std::size_t count) {
  while (buffer_.size() - at_ < count && fill()) {
  }
  return std::string_view(buffer_).substr(at_);
}

std::uint64_t FileWindow::skip(std::uint64_t count) {
  std::uint64_t left = count;
  while (left > 0 && (at_ < buffer_.size() || fill())) {
    const std::uint64_t step = std::min<std::uint64_t>(left, buffer_.size() - at_);
    at_ += static_cast<std::size_t>(step);
    left -= step;
  }
  offset_ += count - left;
  return count - left;
}

}  // namespace trussmap::logs
