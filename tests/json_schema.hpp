// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the command writes with --json, held against its schema (docs/trussmap.schema.json).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::testing {

/// The file that a call of the command writes JSON into; empty: none.
[[nodiscard]] std::filesystem::path json_file_of(const std::string& arguments);

/// The schema's definition for a call of the command: "diagnose", "fleet-report", "build-store".
[[nodiscard]] std::string definition_for(const std::string& arguments);

/// What is wrong with a command's JSON by the schema's definition, a line each; keys that the
/// schema does not describe among it.
[[nodiscard]] std::vector<std::string> against_schema(const nlohmann::json& written,
                                                      const std::string& definition);

}  // namespace trussmap::testing
