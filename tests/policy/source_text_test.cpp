// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Every source names its licence, and none names a place on somebody's machine.
#include "policy/source_files.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::source_text_test {
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

/// Files that the comments of a source name, with their lines.
std::vector<std::pair<int, std::string>> files_in_comments(const std::string& text) {
  static const std::regex kFile(R"((^|[^\w./<-])((\w[\w-]*/)*\w[\w-]*\.(hpp|cpp|md|py))\b)");
  std::vector<std::pair<int, std::string>> found;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t begin = line.find("//");
    if (begin == std::string::npos) continue;
    const std::string comment = line.substr(begin);
    for (std::sregex_iterator one(comment.begin(), comment.end(), kFile), end; one != end; ++one) {
      found.emplace_back(number, (*one)[2].str());
    }
  }
  return found;
}

// What stands in capitals is a name for any.
TEST(SourceText, CommentsNameFilesThatAreThere) {
  const std::vector<std::string> folders = {"include", "src",   "apps", "tests", "docs",
                                            "bench",   "cmake", "maps", "python"};
  std::set<std::string> there;  // by each end of its path
  for (const fs::path& file : source_files(folders)) {
    std::string end;
    for (auto part = file.end(); part != file.begin();) {
      --part;
      end = end.empty() ? part->string() : part->string() + "/" + end;
      there.insert(end);
    }
  }
  static const std::regex kAnyName("[A-Z]{3,}");
  for (const fs::path& file : source_files(folders, {".hpp", ".cpp"})) {
    for (const auto& [line, name] : files_in_comments(text_of(file))) {
      if (std::regex_search(name, kAnyName)) continue;
      EXPECT_TRUE(there.contains(name)) << file << ":" << line << ": there is no " << name;
    }
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

/// Words of ours that a colleague of the field would have to read twice, and the field's.
const std::vector<std::pair<std::string, std::string>>& words_to_avoid() {
  // In segments, so that this file passes its own test.
  static const std::vector<std::pair<std::string, std::string>> words = {
      {std::string("have their ") + "say", "are weighed in"},
      {std::string("closed in ") + "peace", "closed cleanly"},
      {std::string("lays the ") + "frame", "defines the datum"},
      {std::string("which of it ") + "lasts", "which part of it lasts"},
      {std::string("Take ") + "along", "Export"},
      {std::string("with guesses to be ") + "read", "with proposals to check"},
      {std::string("has to stand ") + "against", "is tested against"},
      {std::string("goes the other way round ") + "than", "has the opposite sign"},
      {std::string("bent_") + "weight", "gnc_weight"},
      {std::string("leave_out_") + "strays", "remove_outliers"},
      {std::string("who asks ") + "whether", "whoever tests whether"}};
  return words;
}

TEST(SourceText, KeepsToTheFieldsTerms) {
  const std::vector<std::string> folders = {"include", "src",   "apps",       "tests",
                                            "docs",    "bench", "python/src", "python/trussmap"};
  std::vector<fs::path> files =
      source_files(folders, {".hpp", ".cpp", ".md", ".py", ".pyi", ".js", ".toml"});
  files.insert(files.end(), {"README.md", "CHANGELOG.md", "CONTRIBUTING.md"});
  for (const fs::path& file : files) {
    const std::string text = text_of(file);
    for (const auto& [word, better] : words_to_avoid()) {
      EXPECT_EQ(text.find(word), std::string::npos)
          << file << " says \"" << word << "\", expected words as \"" << better << "\"";
    }
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
}  // namespace trussmap::source_text_test
