// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a private header declares is in its room's namespace: a name says where it comes from.
#include "policy/source_files.hpp"

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::room_namespaces_test {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using testing::text_of;

/// Where a public name has the room's own.
const std::map<std::string, std::string> kOtherNames{{"fit", "fitting"},
                                                     {"build_map", "map_building"}};

/// Stand beside public types, with the reason.
const std::set<std::string> kBesidePublicTypes{
    "src/geometry/index.hpp",      // idx: in every formula
    "src/map/graph_model.hpp",     // Boost.Graph looks for them beside LandmarkGraph
    "src/map/builder_memory.hpp",  // a friend of MapBuilder
    "src/map/builder_state.hpp"};  // MapBuilder::State

std::string namespace_of(const fs::path& header) {
  const std::string room = std::next(header.begin())->string();
  const auto other = kOtherNames.find(room);
  return "trussmap::" + (other == kOtherNames.end() ? room : other->second);
}

/// Lines outside of `wanted` and of namespaces within, other than names of types declared there.
std::vector<std::string> strangers(const std::string& text, const std::string& wanted) {
  static const std::regex kNamespace("^namespace (trussmap[A-Za-z0-9_:]*) \\{$");
  static const std::regex kDeclared("^(?:class|struct|enum class) [A-Za-z0-9_]+;$");
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string line;
  std::string open;
  std::smatch match;
  while (std::getline(lines, line)) {
    if (std::regex_match(line, match, kNamespace)) {
      open = match[1];
    } else if (!open.empty() && line == "}  // namespace " + open) {
      open.clear();
    } else if (!open.empty() && open != wanted && !open.starts_with(wanted + "::") &&
               !line.empty() && !line.starts_with("//") && !std::regex_match(line, kDeclared)) {
      found.push_back(line);
    }
  }
  return found;
}

TEST(RoomNamespaces, HoldWhatPrivateHeadersDeclare) {
  std::size_t headers = 0;
  for (const fs::path& header : source_files({"src"}, {".hpp"})) {
    if (kBesidePublicTypes.contains(header.string())) continue;
    const std::vector<std::string> wrong = strangers(text_of(header), namespace_of(header));
    EXPECT_TRUE(wrong.empty()) << header << ": not in " << namespace_of(header) << ": "
                               << wrong.front();
    ++headers;
  }
  EXPECT_GT(headers, 300u);
}

TEST(RoomNamespaces, StrangersAreFound) {
  const std::string home =
      "namespace trussmap::fit {\nstruct X {};\n}  // namespace trussmap::fit\n";
  const std::string inside =
      "namespace trussmap::fit::y {\nint f();\n}  // namespace trussmap::fit::y\n";
  const std::string named = "namespace trussmap {\nstruct Y;\n}  // namespace trussmap\n";
  const std::string other = "namespace trussmap {\nint f();\n}  // namespace trussmap\n";
  EXPECT_TRUE(strangers(home + inside + named, "trussmap::fit").empty());
  EXPECT_EQ(strangers(home + other, "trussmap::fit"), std::vector<std::string>{"int f();"});
  EXPECT_EQ(strangers(home, "trussmap::map").size(), 1u);
  EXPECT_EQ(namespace_of("src/fit/fit_state.hpp"), "trussmap::fitting");
  EXPECT_EQ(namespace_of("src/estimation/kinds/kinds.hpp"), "trussmap::estimation");
}

}  // namespace
}  // namespace trussmap::room_namespaces_test
