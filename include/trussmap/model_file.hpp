// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model as a TOML file: [robot], [noise], [[effect]] (effects/model.hpp).
#pragma once

#include "trussmap/model.hpp"

#include <filesystem>
#include <string>

namespace trussmap {

/// Absent keys keep their defaults. Throws InputError with file and line: no TOML, an unknown key,
/// a wrong type, a wheelbase that is not positive, a negative noise, a coefficient count that does
/// not match the shapes.
[[nodiscard]] Model read_model(const std::filesystem::path& file);

/// The model as TOML; numbers read back exactly.
[[nodiscard]] std::string format_model(const Model& model);

void write_model(const std::filesystem::path& file, const Model& model);

}  // namespace trussmap
