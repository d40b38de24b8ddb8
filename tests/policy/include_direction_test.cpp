// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Chapters build on each other in one direction. Every #include of include/ and src/ is read, and
// one that points the wrong way fails.
#include "policy/source_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using Chapters = std::set<std::string>;

/// What a chapter includes directly; what those include, it may include too. The two outermost
/// chapters, io and report, may include every one of these and none may include them.
const std::map<std::string, Chapters> kFoundations = {
    {"core", {}},
    {"recording", {"core"}},
    {"effects", {"recording"}},
    {"odometry", {"effects"}},
    {"graph", {"odometry"}},
    {"truss", {"core"}},
    {"correction", {"graph", "truss"}},
    {"adjustment", {"graph", "truss"}},
    {"calibration", {"odometry"}},
    {"criticism", {"adjustment"}},
    // A simulator that shared the estimators' formulas would prove nothing about them.
    {"simulation", {"recording", "effects"}},
    {"experiment", {"simulation", "correction", "adjustment"}},
};

void collect(const std::string& chapter, Chapters& found) {
  if (!found.insert(chapter).second) return;
  for (const std::string& foundation : kFoundations.at(chapter)) collect(foundation, found);
}

/// The chapters that `chapter` may include, itself among them; none for an unknown chapter.
std::optional<Chapters> allowed(const std::string& chapter) {
  Chapters found;
  if (chapter == "io" || chapter == "report") {
    for (const auto& [name, foundations] : kFoundations) found.insert(name);
    found.insert(chapter);
  } else if (kFoundations.contains(chapter)) {
    collect(chapter, found);
  } else {
    return std::nullopt;
  }
  return found;
}

/// The chapter of "include/trussmap/X/…" and "src/X/…".
std::string chapter_of(const fs::path& file) {
  const std::vector<fs::path> parts(file.begin(), file.end());
  const std::size_t depth = parts.at(0) == "include" ? 2 : 1;
  return parts.at(depth).string();
}

/// What is wrong with the includes of a file of this name and text, a line each.
std::vector<std::string> wrong_includes(const fs::path& file, std::istream& text) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  const std::string chapter = chapter_of(file);
  const std::optional<Chapters> may_include = allowed(chapter);
  if (!may_include) return {file.string() + ": there is no chapter " + chapter};

  std::vector<std::string> wrong;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    fs::path target = match[2].str();
    const bool in_library = target.begin()->string() == "trussmap";
    if (!in_library && match[1] == "<") continue;
    // Ours by its full name, or a private header named relative to the file.
    target = in_library ? "include" / target : (file.parent_path() / target).lexically_normal();
    if (may_include->contains(chapter_of(target))) continue;
    wrong.push_back(file.string() + ":" + std::to_string(number) + ": " + chapter +
                    " must not include " + match[2].str());
  }
  return wrong;
}

std::vector<std::string> wrong_includes(const fs::path& file, const std::string& text) {
  std::istringstream stream(text);
  return wrong_includes(file, stream);
}

TEST(IncludeDirection, EveryIncludePointsTowardsTheFoundations) {
  int read = 0;
  for (const fs::path& file : source_files({"include", "src"}, {".hpp", ".cpp"})) {
    std::ifstream text(fs::path(TRUSSMAP_SOURCE_DIR) / file);
    ASSERT_TRUE(text) << file;
    for (const std::string& complaint : wrong_includes(file, text)) ADD_FAILURE() << complaint;
    ++read;
  }
  EXPECT_GT(read, 20);
}

TEST(IncludeDirection, LibrariesStayBehindTheirHeaders) {
  // Used in the sources alone, so that nobody who includes our headers needs them.
  static const std::regex kPrivate(R"(#\s*include\s*<(cholmod|muParser|lzma|toml\+\+|CLI/))");
  for (const fs::path& file : source_files({"include"}, {".hpp"})) {
    EXPECT_FALSE(std::regex_search(testing::text_of(file), kPrivate)) << file;
  }
}

TEST(IncludeDirection, NoChapterRestsOnItself) {
  for (const auto& [chapter, foundations] : kFoundations) {
    for (const std::string& foundation : foundations) {
      ASSERT_TRUE(kFoundations.contains(foundation)) << foundation;
      EXPECT_FALSE(allowed(foundation)->contains(chapter)) << chapter << " and " << foundation;
    }
  }
}

TEST(IncludeDirection, TransitiveFoundationsAreAllowed) {
  EXPECT_TRUE(wrong_includes("src/criticism/x.cpp",
                             "#include \"trussmap/core/planar.hpp\"\n"
                             "#include " map /
                                 route.hpp "\n"
                                           "#include \"private.hpp\"\n"
                                           "#include <vector>\n")
                  .empty());
}

TEST(IncludeDirection, WrongWaysAreFound) {
  const auto wrong = [](const char* file, const char* include) {
    return wrong_includes(file, std::string("#include ") + include).size() == 1;
  };
  EXPECT_TRUE(wrong("src/core/x.cpp", "\"trussmap/truss/truss.hpp\""));
  EXPECT_TRUE(wrong("include/trussmap/truss/x.hpp", "<trussmap/odometry/arc.hpp>"));
  EXPECT_TRUE(wrong("src/simulation/x.cpp", "\"trussmap/odometry/arc.hpp\""));
  EXPECT_TRUE(wrong("src/experiment/x.cpp", "\"trussmap/report/table.hpp\""));
  EXPECT_TRUE(wrong("src/io/x.cpp", "\"trussmap/report/table.hpp\""));
  EXPECT_TRUE(wrong("src/graph/x.cpp", "\"../correction/nearest_landmarks.hpp\""));
  EXPECT_TRUE(wrong("src/graph/x.cpp", "\"trussmap/nowhere/x.hpp\""));
  EXPECT_TRUE(wrong("src/nowhere/x.cpp", "\"trussmap/core/planar.hpp\""));
}

}  // namespace
}  // namespace trussmap
