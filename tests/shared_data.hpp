// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the tests find reference numbers (always) and shared data sets (where there are any).
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::testing {

inline nlohmann::json reference(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(TRUSSMAP_REFERENCE_DIR) / name;
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error("no reference file " + path.string());
  return nlohmann::json::parse(stream);
}

/// A case of a reference file.
struct Case {
  std::size_t number = 0;
  nlohmann::json content;
};

inline std::vector<Case> cases(const std::string& file, const std::string& key) {
  std::vector<Case> result;
  const nlohmann::json all = reference(file);
  for (const nlohmann::json& content : all[key]) {
    result.push_back({result.size(), content});
  }
  return result;
}

/// Checks every case; a failure says which. Not test parameters: every test is a process, and each
/// would read all files to know its parameters.
template <typename Check>
void for_each(const std::vector<Case>& all, const Check& check) {
  ASSERT_FALSE(all.empty());
  for (const Case& one : all) {
    SCOPED_TRACE("case " + std::to_string(one.number));
    check(one.content);
  }
}

inline std::filesystem::path shared(const std::string& below) {
  return std::filesystem::path(TRUSSMAP_SHARED_DIR) / below;
}

}  // namespace trussmap::testing

/// Skips the test, saying so, where the shared data sets are absent.
#define TRUSSMAP_NEEDS_SHARED(below)                                                \
  if (!std::filesystem::exists(trussmap::testing::shared(below))) {                 \
    GTEST_SKIP() << "needs the shared data set " << (below) << ", which is absent"; \
  }
