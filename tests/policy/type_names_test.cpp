// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// No two types of one name: a vector of either would be taken for a vector of the other by the
// linker, which says nothing. Nor does a source give a type of its own the name of a public one:
// sources of the shared library see all public headers.
#include "policy/source_files.hpp"

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::type_names_test {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using testing::text_of;

struct TypeName {
  std::string scope;  ///< namespaces, without unnamed ones
  std::string name;
  bool in_unnamed = false;

  [[nodiscard]] std::string whole() const { return scope + "::" + name; }
};

/// Types defined outside of functions and other types, in a file that our clang-format has seen.
std::vector<TypeName> defined_types(const std::string& text) {
  static const std::regex kNamespace("^(?:inline )?namespace ?([A-Za-z0-9_:]*) ?\\{$");
  static const std::regex kType("^(?:enum class|enum|class|struct) ([A-Za-z0-9_]+)( [^;]*)?\\{.*");
  std::vector<std::string> scopes;
  std::vector<TypeName> found;
  std::istringstream lines(text);
  std::string line;
  std::smatch match;
  while (std::getline(lines, line)) {
    if (std::regex_match(line, match, kNamespace)) {
      scopes.push_back(match[1]);
    } else if (line.starts_with("}  // namespace")) {
      if (!scopes.empty()) scopes.pop_back();
    } else if (std::regex_match(line, match, kType)) {
      TypeName type{{}, match[1], false};
      for (const std::string& scope : scopes) {
        type.in_unnamed = type.in_unnamed || scope.empty();
        type.scope += scope.empty() ? "" : "::" + scope;
      }
      found.push_back(type);
    }
  }
  return found;
}

/// What is wrong with these files (by name, their texts), of which some are public headers.
std::vector<std::string> clashes(const std::map<std::string, std::string>& files,
                                 const std::set<std::string>& public_headers) {
  std::map<std::string, std::string> defined;  // where, by whole name
  std::vector<std::string> result;
  for (const auto& [file, text] : files) {
    for (const TypeName& type : defined_types(text)) {
      if (type.in_unnamed) continue;
      const auto [where, is_new] = defined.emplace(type.whole(), file);
      if (!is_new) result.push_back(type.whole() + ": " + where->second + ", " + file);
    }
  }
  for (const auto& [file, text] : files) {
    for (const TypeName& type : defined_types(text)) {
      const auto other = defined.find(type.whole());
      if (type.in_unnamed && other != defined.end() && public_headers.contains(other->second))
        result.push_back(type.whole() + ": " + other->second + ", unnamed in " + file);
    }
  }
  return result;
}

TEST(TypeNames, AreEachOneTypes) {
  std::map<std::string, std::string> files;
  std::set<std::string> public_headers;
  for (const fs::path& file : source_files({"include", "src"}, {".hpp", ".cpp"}))
    files[file.string()] = text_of(file);
  for (const fs::path& file : source_files({"include"})) public_headers.insert(file.string());
  ASSERT_GT(public_headers.size(), 40u);
  std::size_t types = 0;
  for (const auto& [file, text] : files) types += defined_types(text).size();
  EXPECT_GT(types, 800u);
  for (const std::string& clash : clashes(files, public_headers)) ADD_FAILURE() << clash;
}

TEST(TypeNames, ClashesAreFound) {
  const std::string open = "namespace a {\n";
  const std::string close = "}  // namespace a\n";
  const std::string unnamed = "namespace {\nstruct X {};\n}  // namespace\n";
  const std::string twice = open + "struct X {\n  struct Y {};\n};\n" + close;
  const std::string declared = open + "struct X;\n" + close;
  const std::set<std::string> is_public = {"h"};
  EXPECT_EQ(clashes({{"h", twice}, {"s", twice}}, is_public).size(), 1u);
  EXPECT_EQ(clashes({{"h", twice}, {"s", declared}}, is_public).size(), 0u);
  EXPECT_EQ(clashes({{"h", twice}, {"s", open + unnamed + close}}, is_public).size(), 1u);
  EXPECT_EQ(clashes({{"g", twice}, {"s", open + unnamed + close}}, is_public).size(), 0u);
  EXPECT_EQ(clashes({{"h", twice}, {"s", unnamed}}, is_public).size(), 0u);
  EXPECT_EQ(clashes({{"h", twice}, {"s", open + "enum class X {\n  a\n};\n" + close}}, is_public),
            std::vector<std::string>{"::a::X: h, s"});
}

}  // namespace
}  // namespace trussmap::type_names_test
