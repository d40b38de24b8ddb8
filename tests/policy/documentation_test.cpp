// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// README and docs: short enough to be read, and nothing that they point at is missing.
#include "policy/source_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::documentation_test {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using testing::text_of;

/// The README first, then docs/ and the notes beside benches and examples.
std::vector<fs::path> pages() {
  std::vector<fs::path> result{"README.md", "CONTRIBUTING.md"};
  const std::vector<fs::path> others = source_files({"docs", "bench", "maps"}, {".md"});
  result.insert(result.end(), others.begin(), others.end());
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The lines outside of code blocks, whose brackets are no links.
std::string prose_of(const std::string& page) {
  std::string prose;
  bool code = false;
  for (const std::string& line : lines_of(page)) {
    const bool fence = line.rfind("```", 0) == 0;
    if (!fence && !code) prose += line + '\n';
    code = code != fence;
  }
  return prose;
}

/// What a pattern's first group finds in a text.
std::vector<std::string> found_in(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), pattern);
       at != std::sregex_iterator(); ++at) {
    found.push_back((*at)[1].str());
  }
  return found;
}

/// Targets of [text](target) and of <img src="target">, other sites left out.
std::vector<std::string> relative_links(const std::string& page) {
  static const std::regex kLink(R"re((?:\]\(|<img src=")([^)"\s]+))re");
  static const std::regex kElsewhere("[a-z]+:.*");
  std::vector<std::string> links = found_in(prose_of(page), kLink);
  std::erase_if(links, [](const std::string& link) { return std::regex_match(link, kElsewhere); });
  return links;
}

/// What a heading is called in a link: small letters, hyphens for spaces, no punctuation.
std::set<std::string> anchors_of(const std::string& page) {
  static const std::regex kHeading(R"((?:^|\n)#+ ([^\n]+))");
  std::set<std::string> anchors;
  for (const std::string& heading : found_in(prose_of(page), kHeading)) {
    std::string anchor;
    for (const char c : heading) {
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) != 0 || c == '-' || c == '_') {
        anchor += static_cast<char>(std::tolower(byte));
      } else if (c == ' ') {
        anchor += '-';
      }
    }
    anchors.insert(anchor);
  }
  return anchors;
}

bool resolves(const fs::path& page, const std::string& link) {
  const std::size_t hash = link.find('#');
  const std::string path = link.substr(0, hash);
  const fs::path target = path.empty() ? page : (page.parent_path() / path).lexically_normal();
  if (!fs::exists(fs::path(TRUSSMAP_SOURCE_DIR) / target)) return false;
  return hash == std::string::npos || anchors_of(text_of(target)).contains(link.substr(hash + 1));
}

/// Paths of the project's own, and headers by their name, that stand in `code`.
std::vector<std::string> named_paths(const std::string& page) {
  static const std::regex kPath(
      R"(`((?:src|include|apps|tests|bench|maps|docs|cmake)/[A-Za-z0-9_./-]*)`)");
  static const std::regex kHeader(R"([`<](trussmap/[a-z_]+\.hpp)[`>])");
  std::vector<std::string> paths = found_in(page, kPath);
  std::erase_if(paths, [](const std::string& path) {
    return path.find("/ROOM") != std::string::npos || path.find("NAME") != std::string::npos;
  });
  for (const std::string& header : found_in(page, kHeader)) paths.push_back("include/" + header);
  return paths;
}

TEST(Documentation, ReadmeIsShort) {
  EXPECT_LE(lines_of(text_of("README.md")).size(), 120U);
}

TEST(Documentation, RelativeLinksResolve) {
  int links = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& link : relative_links(text_of(page))) {
      EXPECT_TRUE(resolves(page, link)) << page.string() << " links to " << link;
      ++links;
    }
  }
  EXPECT_GT(links, 20);
}

TEST(Documentation, NamedFilesExist) {
  const fs::path top(TRUSSMAP_SOURCE_DIR);
  for (const fs::path& page : pages()) {
    for (const std::string& path : named_paths(text_of(page))) {
      // A note in a folder may name what lies beside it.
      EXPECT_TRUE(fs::exists(top / path) || fs::exists(top / page.parent_path() / path))
          << page.string() << " names " << path;
    }
  }
}

/// The text from one heading to the next of the same kind.
std::string section_of(const std::string& page, const std::string& heading) {
  const std::size_t begin = page.find("\n## " + heading);
  if (begin == std::string::npos) return "";
  return page.substr(begin, page.find("\n## ", begin + 1) - begin);
}

/// The first cells of a section's table, as far as they are names in `code`.
std::set<std::string> names_in(const std::string& section, const std::regex& row) {
  static const std::regex kName("`([a-z_]+)`");
  std::set<std::string> names;
  for (const std::string& cell : found_in(section, row)) {
    for (const std::string& name : found_in(cell, kName)) names.insert(name);
  }
  return names;
}

void expect_same(const std::set<std::string>& named, const std::set<std::string>& there) {
  for (const std::string& name : named)
    EXPECT_TRUE(there.contains(name)) << name << " is not there";
  for (const std::string& name : there)
    EXPECT_TRUE(named.contains(name)) << name << " is not named";
}

TEST(Documentation, GuideHasEveryPublicHeader) {
  static const std::regex kRow(R"(\n\| ?[0-9]* ?\| ([^|]*) \|)");  // | part | header | ...
  std::set<std::string> headers;
  for (const fs::path& header : source_files({"include"}, {".hpp"})) {
    if (header.stem() != "trussmap") headers.insert(header.stem().string());
  }
  expect_same(names_in(section_of(text_of("docs/reading-the-code.md"), "Public headers"), kRow),
              headers);
}

TEST(Documentation, GuideHasEveryRoom) {
  static const std::regex kRow(R"(\n\| ([^|]*) \|)");  // | room | ...
  std::set<std::string> rooms;
  for (const auto& entry : fs::directory_iterator(fs::path(TRUSSMAP_SOURCE_DIR) / "src")) {
    if (entry.is_directory()) rooms.insert(entry.path().filename().string());
  }
  expect_same(names_in(section_of(text_of("docs/reading-the-code.md"), "Rooms"), kRow), rooms);
}

TEST(Documentation, LapsesAreFound) {
  EXPECT_TRUE(resolves("README.md", "docs/README.md"));
  EXPECT_TRUE(resolves("docs/README.md", "../README.md#licence"));
  EXPECT_TRUE(resolves("docs/formats.md", "#json-keys"));
  EXPECT_FALSE(resolves("docs/README.md", "README.md#licence"));
  EXPECT_FALSE(resolves("README.md", "docs/nowhere.md"));
  const std::vector<std::string> links{"a.md", "b.svg"};
  EXPECT_EQ(relative_links("[x](a.md) [y](https://z.org)\n```\nf[](c)\n```\n<img src=\"b.svg\">"),
            links);
  const std::vector<std::string> paths{"src/io", "include/trussmap/x.hpp"};
  EXPECT_EQ(named_paths("`src/io`, `src/ROOM/`, `#include <trussmap/x.hpp>`"), paths);
}

}  // namespace
}  // namespace trussmap::documentation_test
