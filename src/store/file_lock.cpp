// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace trussmap::store {
namespace {

[[noreturn]] void fail(int descriptor) {
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  throw std::system_error(reason, std::generic_category());
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file) : file_(file) {
  while (true) {
    constexpr mode_t kAnybody = 0666;  // less the umask
    const int descriptor =
        ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kAnybody);
    if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) != 0) fail(descriptor);
    // The one who held it may have removed the file between the two calls: then it is no lock.
    struct stat locked {};
    struct stat there {};
    if (::fstat(descriptor, &locked) != 0) fail(descriptor);
    if (::lstat(file.c_str(), &there) == 0 && there.st_ino == locked.st_ino &&
        there.st_dev == locked.st_dev) {
      descriptor_ = descriptor;
      return;
    }
    ::close(descriptor);
  }
}

FileLock::~FileLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace trussmap::store
