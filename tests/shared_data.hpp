// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the tests find reference numbers (always) and shared data sets (where there are any).
#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>
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

/// A case of a reference file as a test parameter: printed as its number, not as its contents.
struct Case {
  std::size_t number = 0;
  nlohmann::json content;
};

inline void PrintTo(const Case& one, std::ostream* stream) {
  *stream << "case " << one.number;
}

inline std::vector<Case> cases(const std::string& file, const std::string& key) {
  std::vector<Case> result;
  const nlohmann::json all = reference(file);
  for (const nlohmann::json& content : all[key]) {
    result.push_back({result.size(), content});
  }
  return result;
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
