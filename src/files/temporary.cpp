// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/temporary.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <random>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace trussmap::files {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".trussmap-part";
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t kDrawn = 12;     // 60 bits
constexpr std::size_t kLongest = 100;  // bytes of NAME: some file systems end at 143 in all
constexpr mode_t kAnyone = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH;
constexpr mode_t kAnyoneEnters = kAnyone | S_IXUSR | S_IXGRP | S_IXOTH;

std::string drawn() {
  std::random_device random;
  std::string text;
  for (std::size_t k = 0; k < kDrawn; ++k) text += kLetters[random() % kLetters.size()];
  return text;
}

/// The first bytes of a name, without half a character at the end.
std::string cut(const std::string& name) {
  if (name.size() <= kLongest) return name;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end);
}

bool is_at(int descriptor, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Between the making and the lock somebody may have taken it for a leftover.
Descriptor locked(Descriptor made, const fs::path& temporary) {
  if (!made.valid()) return made;
  const bool taken = ::flock(made.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!taken && is_at(made.number(), temporary)) return made;
  static_cast<void>(made.close());
  errno = EEXIST;
  return Descriptor();
}

/// Opened and locked, if it is a killed run's.
Descriptor abandoned(const fs::path& temporary, const struct stat& seen) {
  const int how = S_ISDIR(seen.st_mode) ? O_RDONLY | O_DIRECTORY : O_RDWR;
  Descriptor opened(::open(temporary.c_str(), how | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!opened.valid() || ::flock(opened.number(), LOCK_EX | LOCK_NB) != 0 ||
      !is_at(opened.number(), temporary)) {
    return Descriptor();
  }
  return opened;
}

void remove_if_abandoned(const fs::path& temporary) {
  struct stat seen {};
  if (::lstat(temporary.c_str(), &seen) != 0 || seen.st_uid != ::geteuid()) return;
  const bool folder = S_ISDIR(seen.st_mode);
  if (!folder && !S_ISREG(seen.st_mode)) return;
  const Descriptor held = abandoned(temporary, seen);
  if (!held.valid()) return;
  if (!folder) {
    ::unlink(temporary.c_str());
    return;
  }
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(temporary, ignored)) {
    ::unlink(entry.path().c_str());  // refuses folders
  }
  ::rmdir(temporary.c_str());
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    static_cast<void>(close());
    number_ = other.number_;
    other.number_ = -1;
  }
  return *this;
}

bool Descriptor::close() {
  if (number_ < 0) return true;
  const int closing = number_;
  number_ = -1;
  return ::close(closing) == 0 || errno == EINTR;
}

fs::path temporary_for(const fs::path& target) {
  return target.parent_path() /
         ("." + cut(target.filename().string()) + "." + drawn() + std::string(kEnding));
}

bool is_temporary_name(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kEnding)) return false;
  name.remove_suffix(kEnding.size());
  if (name.size() < kDrawn + 2) return false;
  const std::string_view last = name.substr(name.size() - kDrawn);
  return name[name.size() - kDrawn - 1] == '.' &&
         last.find_first_not_of(kLetters) == std::string_view::npos;
}

Descriptor make_temporary_file(const fs::path& temporary) {
  return locked(Descriptor(::open(temporary.c_str(),
                                  O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kAnyone)),
                temporary);
}

Descriptor make_temporary_folder(const fs::path& temporary) {
  if (::mkdir(temporary.c_str(), kAnyoneEnters) != 0) return Descriptor();
  Descriptor opened(::open(temporary.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!opened.valid() && errno == ENOENT) errno = EEXIST;
  return locked(std::move(opened), temporary);
}

bool write_all(int descriptor, std::string_view content, bool lasting) {
  while (!content.empty()) {
    const ssize_t count = ::write(descriptor, content.data(), content.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(count));
  }
  return !lasting || ::fsync(descriptor) == 0;
}

bool keep_folder(const fs::path& folder) {
  const Descriptor opened(
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.valid()) return true;  // a folder may be written to by those who may not read it
  return ::fsync(opened.number()) == 0 || errno == EINVAL || errno == ENOTSUP;
}

void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry :
       fs::directory_iterator(folder.empty() ? fs::path(".") : folder, ignored)) {
    if (is_temporary_name(entry.path().filename().string())) remove_if_abandoned(entry.path());
  }
}

}  // namespace trussmap::files
