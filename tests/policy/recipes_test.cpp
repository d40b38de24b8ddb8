// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The recipes of packages that nothing here builds name what the build looks for, the version that
// it is, and options that there are.
#include "policy/source_files.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::recipes_test {
namespace {

using testing::source_files;
using testing::text_of;

/// What somebody calls the package that CMake looks for.
struct Names {
  std::string debian;
  std::string vcpkg;
  std::vector<std::string> conda;
};

const std::map<std::string, Names> kNames = {
    {"Eigen3", {"libeigen3-dev", "eigen3", {"eigen"}}},
    {"Cholmod", {"libsuitesparse-dev", "suitesparse-cholmod", {"suitesparse"}}},
    {"LAPACK", {"libopenblas-dev", "lapack", {"libblas", "liblapack"}}},
    {"Boost", {"libboost-graph-dev", "boost-graph", {"libboost-headers"}}},
    {"fmt", {"libfmt-dev", "fmt", {"fmt"}}},
    {"nlohmann_json", {"nlohmann-json3-dev", "nlohmann-json", {"nlohmann_json"}}},
    {"tomlplusplus", {"libtomlplusplus-dev", "tomlplusplus", {"tomlplusplus"}}},
    {"muparser", {"libmuparser-dev", "muparser", {"muparser"}}},
    {"LibLZMA", {"liblzma-dev", "liblzma", {"liblzma-devel"}}},
    {"EXPAT", {"libexpat1-dev", "expat", {"expat"}}},
    {"SQLite3", {"libsqlite3-dev", "sqlite3", {"libsqlite"}}},
    {"BZip2", {"libbz2-dev", "bzip2", {"bzip2"}}},
    {"Lz4", {"liblz4-dev", "lz4", {"lz4-c"}}},
    {"zstd", {"libzstd-dev", "zstd", {"zstd"}}},
    {"ZLIB", {"zlib1g-dev", "zlib", {"zlib"}}},
    {"yaml-cpp", {"libyaml-cpp-dev", "yaml-cpp", {"yaml-cpp"}}}};

std::set<std::string> all_matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
    found.insert((*it)[1]);
  return found;
}

std::string part_of(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find(to, begin + from.size()) - begin);
}

/// What the library is looked for at all times: top level, not within an if.
std::set<std::string> looked_for() {
  return all_matches(text_of("CMakeLists.txt"), "\nfind_package\\(([A-Za-z0-9_-]+)");
}

std::string version() {
  return *all_matches(text_of("CMakeLists.txt"), "project\\(trussmap VERSION ([0-9.]+)").begin();
}

TEST(Recipes, KnowWhatTheBuildLooksFor) {
  std::set<std::string> known;
  for (const auto& [name, names] : kNames) known.insert(name);
  EXPECT_EQ(looked_for(), known);
}

TEST(Recipes, OfDebianNamesWhatIsNeeded) {
  const std::string control = text_of("packaging/debian/control");
  const std::set<std::string> needed =
      all_matches(part_of(control, "Build-Depends:", "\n\n"), "([a-z0-9.+-]{3,})");
  const std::set<std::string> installed =
      all_matches(text_of(".ci/install-deps"), "([a-z0-9.+-]{3,})");
  for (const auto& [name, names] : kNames) {
    EXPECT_TRUE(needed.contains(names.debian)) << name;
    EXPECT_TRUE(installed.contains(names.debian)) << name;
  }
  // Native packages: one version everywhere.
  EXPECT_TRUE(
      text_of("packaging/debian/changelog").starts_with("trussmap (" + version() + ") unstable"));
}

TEST(Recipes, OfDebianNamesTheLibraryByItsBinaryInterface) {
  // Until 1.0 each minor version has one of its own.
  std::smatch parts;
  const std::string is = version();
  ASSERT_TRUE(std::regex_match(is, parts, std::regex("([0-9]+)\\.([0-9]+)\\.[0-9]+")));
  const std::string so = parts[1] == "0" ? "0." + parts[2].str() : parts[1].str();
  const std::string package = "libtrussmap" + so;
  const std::string control = text_of("packaging/debian/control");
  EXPECT_NE(control.find("\nPackage: " + package + "\n"), std::string::npos);
  EXPECT_NE(control.find("Depends: " + package + " (= ${binary:Version})"), std::string::npos);
  EXPECT_TRUE(text_of("packaging/debian/" + package + ".symbols")
                  .starts_with("libtrussmap.so." + so + " " + package +
                               " #MINVER#\n (symver)TRUSSMAP_" + so + " "));
  EXPECT_FALSE(text_of("packaging/debian/" + package + ".install").empty());
}

TEST(Recipes, OfVcpkgNamesWhatIsNeeded) {
  const nlohmann::json port = nlohmann::json::parse(text_of("packaging/vcpkg/trussmap/vcpkg.json"));
  EXPECT_EQ(port.at("version"), version());
  std::set<std::string> named;
  for (const nlohmann::json& one : port.at("dependencies"))
    if (one.is_string()) named.insert(one.get<std::string>());
  std::set<std::string> needed = {"boost-geometry"};
  for (const auto& [name, names] : kNames) needed.insert(names.vcpkg);
  EXPECT_EQ(named, needed);
}

TEST(Recipes, OfCondaNamesWhatIsNeeded) {
  const std::string recipe = text_of("packaging/conda/meta.yaml");
  EXPECT_EQ(all_matches(recipe, "\n  version: (\\S+)"), std::set<std::string>{version()});
  std::set<std::string> named =
      all_matches(part_of(recipe, "\n  host:\n", "\n  run:\n"), "\n    - ([a-z0-9_-]+)");
  for (const char* of_python : {"python", "numpy", "pybind11"})
    EXPECT_EQ(named.erase(of_python), 1u);
  std::set<std::string> needed;
  for (const auto& [name, names] : kNames) needed.insert(names.conda.begin(), names.conda.end());
  EXPECT_EQ(named, needed);
}

TEST(Recipes, SetOptionsThatThereAre) {
  std::string cmake;
  for (const auto& file : source_files({"cmake", "python"}, {".cmake", ".txt"}))
    cmake += text_of(file);
  cmake += text_of("CMakeLists.txt");
  for (const char* file : {"packaging/debian/rules", "packaging/conda/meta.yaml",
                           "packaging/vcpkg/trussmap/portfile.cmake"}) {
    const std::set<std::string> set =
        all_matches(text_of(file), "-D ((?:TRUSSMAP|BUILD)_[A-Z_]+)=");
    EXPECT_FALSE(set.empty()) << file;
    for (const std::string& option : set) {
      EXPECT_TRUE(std::regex_search(cmake, std::regex("(option|set)\\(" + option + "\\s")))
          << file << " sets " << option;
    }
  }
}

}  // namespace
}  // namespace trussmap::recipes_test
