// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// JSON files that commands have written.
#pragma once

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

namespace trussmap::testing {

/// Throws nlohmann::json::exception where it is none.
inline nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return nlohmann::json::parse(stream);
}

}  // namespace trussmap::testing
