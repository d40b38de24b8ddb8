// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whole files in and out.
#pragma once

#include <string>

namespace trussmap {

/// The file's text; decompressed if the name ends in .xz. Throws InputError.
[[nodiscard]] std::string read_file(const std::string& path);

/// Writes to a temporary file beside `path` and renames it, so that nobody sees half a file.
/// Throws InputError.
void write_file(const std::string& path, const std::string& content);

}  // namespace trussmap
