// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the library calls of CHOLMOD, whose modules have different licences.
#include "policy/source_files.hpp"

#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::licence_test {
namespace {

/// Modify, MatrixOps and Supernodal are under the GPL; these are of Core and Cholesky (LGPL).
const std::set<std::string> kUnderTheLgpl{
    "cholmod_start",   "cholmod_finish",       "cholmod_free_dense", "cholmod_free_factor",
    "cholmod_analyze", "cholmod_solve",        "cholmod_solve2",     "cholmod_factorize",
    "cholmod_rcond",   "cholmod_change_factor"};

TEST(Licence, OnlyModulesUnderTheLgplAreCalled) {
  const std::regex call("(cholmod_[a-z0-9_]+)\\(");
  std::set<std::string> called;
  for (const auto& file : testing::source_files({"src", "apps", "include"}, {".cpp", ".hpp"})) {
    const std::string text = testing::text_of(file);
    for (auto at = std::sregex_iterator(text.begin(), text.end(), call);
         at != std::sregex_iterator(); ++at) {
      const std::string name = (*at)[1];
      called.insert(name);
      EXPECT_TRUE(kUnderTheLgpl.contains(name)) << file << ": " << name;
    }
  }
  EXPECT_TRUE(called.contains("cholmod_factorize"));  // what is looked for is found
}

}  // namespace
}  // namespace trussmap::licence_test
