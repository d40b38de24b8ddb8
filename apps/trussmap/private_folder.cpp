// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "private_folder.hpp"

#include "trussmap/error.hpp"

#include <cstdlib>
#include <system_error>

namespace trussmap::app {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder() : path_((fs::temp_directory_path() / "trussmap-XXXXXX").string()) {
  if (::mkdtemp(path_.data()) != nullptr) return;
  throw InputError(path_, 0, "cannot be made, expected a folder for temporary files (TMPDIR)");
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string PrivateFolder::without_it(std::string message) const {
  const std::string prefix = path_ + '/';
  for (std::size_t at = 0; (at = message.find(prefix, at)) != std::string::npos;) {
    message.erase(at, prefix.size());
  }
  return message;
}

}  // namespace trussmap::app
