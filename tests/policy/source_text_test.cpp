// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Every source names its licence, and none names a place on somebody's machine.
#include "policy/source_files.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using testing::text_of;

/// Both lines at the top, or below a script's "#!" line.
bool names_licence(const std::string& text) {
  static const std::regex kHeader(
      "^(#![^\n]*\n)?(//|#) SPDX-FileCopyrightText: [^\n]+\n(//|#) SPDX-License-Identifier: "
      "MIT\n");
  return std::regex_search(text, kHeader, std::regex_constants::match_continuous);
}

/// The first line (counted from 1) with an absolute path into a folder that only some machine has.
std::optional<int> line_with_machine_path(const std::string& text) {
  // In segments, so that this file passes its own test.
  static const std::regex kMachinePath(
      "(^|[^A-Za-z0-9_.})*/-])/("
      "work|home|tmp|root)/");
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (std::regex_search(line, kMachinePath)) return number;
  }
  return std::nullopt;
}

TEST(SourceText, EverySourceNamesItsLicence) {
  const std::vector<std::string> folders = {"include", "src",   "apps",
                                            "tests",   "cmake", "python/src"};
  for (const fs::path& file : source_files(folders, {".hpp", ".cpp", ".cmake", ".sh"})) {
    EXPECT_TRUE(names_licence(text_of(file))) << file << " lacks the two SPDX lines at its top";
  }
}

TEST(SourceText, NoFileNamesAMachine) {
  // Of python not what pip has built there.
  const std::vector<std::string> folders = {
      "include", "src",   "apps",       "tests",        "cmake",           "maps",
      "docs",    "bench", "python/src", "python/tests", "python/trussmap", ".ci"};
  std::vector<fs::path> files = source_files(folders);
  for (const char* name : {"CMakeLists.txt", "CMakePresets.json", "Makefile", "CHANGELOG.md",
                           "python/CMakeLists.txt", "python/setup.py", "python/pyproject.toml"}) {
    files.emplace_back(name);
  }
  for (const fs::path& file : files) {
    if (file.extension() == ".pyc") continue;  // what Python keeps of its sources
    const std::optional<int> line = line_with_machine_path(text_of(file));
    EXPECT_FALSE(line) << file.string() << ":" << *line << ": names an absolute path";
  }
}

TEST(SourceText, LapsesAreFound) {
  const std::string spdx = std::string("SPDX-") + "License-Identifier: MIT\n";
  const std::string author = std::string("SPDX-") + "FileCopyrightText: 2026 X\n";
  EXPECT_TRUE(names_licence("// " + author + "// " + spdx));
  EXPECT_TRUE(names_licence("#!/bin/sh\n# " + author + "# " + spdx));
  EXPECT_FALSE(names_licence("\n// " + author + "// " + spdx));
  EXPECT_FALSE(names_licence("// " + spdx));

  const std::string place = std::string("/") + "tmp/x";
  EXPECT_EQ(line_with_machine_path("a\nb = \"" + place + "\""), 2);
  EXPECT_EQ(line_with_machine_path(place), 1);
  EXPECT_EQ(line_with_machine_path("build" + place), std::nullopt);
}

}  // namespace
}  // namespace trussmap
