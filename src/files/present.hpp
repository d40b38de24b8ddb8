// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "trussmap/error.hpp"

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace trussmap::files {

/// Whether there is something of this name. Throws InputError where nobody can tell: what may not
/// be looked at is not missing.
[[nodiscard]] inline bool is_present(const std::filesystem::path& path) {
  std::error_code unseen;
  const bool present = std::filesystem::exists(path, unseen);
  if (unseen) {
    throw InputError(path.string(), 0,
                     "cannot be looked at: " + unseen.message() + ", expected a readable file");
  }
  return present;
}

/// For a file that is to be read: throws InputError where it has no name or is a folder.
inline void require_file(const std::filesystem::path& path) {
  if (path.empty()) throw InputError("a file", 0, "has an empty name, expected a path");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path.string(), 0, "is a folder, expected a file");
  }
}

/// Of one that could not be opened just now, by errno.
[[nodiscard]] inline InputError unreadable(const std::string& name) {
  const std::string reason = std::generic_category().message(errno);
  return {name, 0, "cannot be opened: " + reason + ", expected a readable file"};
}

}  // namespace trussmap::files
