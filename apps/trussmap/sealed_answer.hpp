// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// truth.json of `simulate --hide`: the answer, encrypted by a key of the program, so that nobody
// reads it by accident. (It is no secret: who has the program has the key.)
//
//   {"note": "...", "cipher": "xor-mt19937-64", "sealed": base64 of the answer's JSON, each byte
//    XOR the low byte of std::mt19937_64 seeded by key and checksum,
//    "checksum": FNV-1a of that JSON, hex}
//
// Without "cipher", as earlier files are, `sealed` is base64 of the JSON itself.
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
