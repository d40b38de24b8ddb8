// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The project's own files, for the tests that read them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace trussmap::testing {

/// The files below these folders (relative to the project's) with these endings; all, if none are
/// given. Sorted, relative to the project's folder.
inline std::vector<std::filesystem::path> source_files(const std::vector<std::string>& folders,
                                                       const std::set<std::string>& endings = {}) {
  const std::filesystem::path top(TRUSSMAP_SOURCE_DIR);
  std::vector<std::filesystem::path> found;
  for (const std::string& folder : folders) {
    if (!std::filesystem::exists(top / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / folder)) {
      if (!entry.is_regular_file()) continue;
      if (!endings.empty() && !endings.contains(entry.path().extension().string())) continue;
      found.push_back(entry.path().lexically_relative(top));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(std::filesystem::path(TRUSSMAP_SOURCE_DIR) / file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace trussmap::testing
