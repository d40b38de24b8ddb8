// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Every input that fuzzing has kept, and every one that it ever failed with.
#include "fuzz/targets.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::fuzz::corpora_test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const fs::directory_entry& one : fs::directory_iterator(folder)) files.push_back(one.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(FuzzCorpora, AreReadOrRefused) {
  const fs::path fuzz = fs::path(TRUSSMAP_SOURCE_DIR) / "tests/fuzz";
  for (const auto& [name, target] : targets()) {
    std::vector<fs::path> files = files_in(fuzz / "corpus" / name);
    EXPECT_GE(files.size(), 2U) << name;
    for (const fs::path& one : files_in(fuzz / "found" / name)) files.push_back(one);
    for (const fs::path& file : files) {
      std::ifstream in(file, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      EXPECT_NO_THROW(target(bytes)) << file;
    }
  }
}

TEST(FuzzCorpora, EveryFolderHasATarget) {
  const fs::path fuzz = fs::path(TRUSSMAP_SOURCE_DIR) / "tests/fuzz";
  for (const char* kind : {"corpus", "found"}) {
    for (const fs::path& folder : files_in(fuzz / kind)) {
      EXPECT_TRUE(targets().contains(folder.filename().string())) << folder;
    }
  }
}

}  // namespace
}  // namespace trussmap::fuzz::corpora_test
