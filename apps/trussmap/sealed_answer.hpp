// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// truth.json of `simulate --hide`: the answer, encoded so that it is not read by accident.
//
//   {"note": "...", "sealed": base64 of the answer's JSON, "checksum": FNV-1a of that JSON, hex}
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace trussmap::app {

inline constexpr const char* kSealedName = "truth.json";

/// Content of truth.json.
[[nodiscard]] std::string sealed(const nlohmann::ordered_json& answer);

/// The answer in a folder's truth.json. Throws InputError where there is none, or a broken one.
[[nodiscard]] nlohmann::ordered_json opened(const std::filesystem::path& folder);

}  // namespace trussmap::app
