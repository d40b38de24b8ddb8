// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A folder of this program's own for what is read back before it is written where it belongs.
#pragma once

#include <filesystem>
#include <string>

namespace trussmap::app {

/// Gone with the object. Throws InputError where there can be none.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return path_; }

  /// A message about files in it, by their names alone.
  [[nodiscard]] std::string without_it(std::string message) const;

 private:
  std::string path_;
};

}  // namespace trussmap::app
