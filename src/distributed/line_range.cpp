// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/line_range.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

constexpr std::int64_t kOverlap = 4096;  // bytes past the range to look for its last line's end

/// Bytes of a file from any place: plain reads, which parallel file systems serve side by side.
class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& path)
      : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) error_ = errno;
  }
  ~Bytes() {
    if (file_ >= 0) ::close(file_);
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  /// Of a regular file, -1 with an error otherwise.
  [[nodiscard]] std::int64_t size() {
    struct stat seen {};
    if (error_ == 0 && ::fstat(file_, &seen) != 0) error_ = errno;
    if (error_ == 0 && !S_ISREG(seen.st_mode)) error_ = S_ISDIR(seen.st_mode) ? EISDIR : ESPIPE;
    return error_ == 0 ? seen.st_size : -1;
  }

  [[nodiscard]] std::string read(std::int64_t from, std::int64_t to) {
    std::string text(idx(std::max<std::int64_t>(to - from, 0)), '\0');
    std::size_t done = 0;
    while (error_ == 0 && done < text.size()) {
      const ssize_t n = ::pread(file_, text.data() + done, text.size() - done,
                                static_cast<off_t>(from) + static_cast<off_t>(done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) error_ = errno;
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    text.resize(done);
    return text;
  }

  [[nodiscard]] int error() const { return error_; }

 private:
  int file_;
  int error_ = 0;
};

std::optional<Fault> unreadable(int error) {
  if (error == 0) return std::nullopt;
  if (error == ESPIPE) {
    return Fault{0, "is no regular file, expected one that can be read in ranges of bytes"};
  }
  return Fault{0, fmt::format("cannot be read: {}", std::strerror(error))};
}

}  // namespace

LineRange read_own_lines(const Communicator& all, const std::filesystem::path& path) {
  Bytes file(path);
  const std::int64_t size = file.size();
  all.agree(path.string(), unreadable(file.error()));
  const auto bound = [&](std::int64_t rank) {  // without overflow
    return size / all.count() * rank + size % all.count() * rank / all.count();
  };
  const std::int64_t begin = bound(all.rank());
  const std::int64_t end = bound(all.rank() + 1);
  // A line begins here if the byte before ends one.
  const std::int64_t seen = std::max<std::int64_t>(begin - 1, 0);
  std::string text = file.read(seen, end);
  const auto own = text.size() - idx(std::min<std::int64_t>(begin - seen, 1));
  const auto newlines = std::count(text.end() - static_cast<std::ptrdiff_t>(own), text.end(), '\n');
  const std::int64_t before = all.sum_before(newlines);

  LineRange lines;
  lines.first_line = 1 + idx(before);
  std::size_t start = 0;
  if (begin > 0) {
    start = text.find('\n');
    if (start == std::string::npos) start = text.size();
    if (start > 0 && start < text.size()) ++lines.first_line;  // the rest of another's last line
    start = std::min(start + 1, text.size());
  }
  if (start < text.size() && text.back() != '\n') {
    for (std::int64_t at = end; at < size && file.error() == 0; at += kOverlap) {
      const std::string more = file.read(at, std::min(at + kOverlap, size));
      const std::size_t found = more.find('\n');
      text.append(more, 0, found);
      if (found != std::string::npos) break;
    }
  }
  all.agree(path.string(), unreadable(file.error()));
  text.erase(0, start);
  lines.text = std::move(text);
  return lines;
}

}  // namespace trussmap::distributed
