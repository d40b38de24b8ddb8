// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One program at a time: a lock on a file beside the one that matters, which goes with the program
// that holds it, however that ends. (A lock on a database's own file would take SQLite's away.)
#pragma once

#include <filesystem>

namespace trussmap::store {

class FileLock {
 public:
  /// Throws std::system_error: EWOULDBLOCK where somebody holds it, else what went wrong.
  explicit FileLock(const std::filesystem::path& file);
  /// Removes the file.
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace trussmap::store
