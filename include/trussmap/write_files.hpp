// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whole files in and out: read at once, written whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

/// The file's bytes; decompressed if the name ends in .xz. Throws InputError if it cannot be read
/// or is no xz file.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Writes to a temporary file beside `path`, then renames it. Throws InputError if that fails;
/// `path` is then as it was.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Several files at once: all temporaries are written before the first is renamed, so
/// that a full disk or a missing right leaves all of them as they were. Folders are not made. A
/// link is followed; a pipe or device (/dev/stdout) is written to as it is. Throws InputError, too,
/// where a path is a folder or is named twice.
void write_files(const std::vector<std::pair<std::filesystem::path, std::string>>& files);

/// Deletes the temporary files of a write_files() that is under way in any thread: for the handler
/// of a signal that ends the program, and safe there.
void discard_temporaries() noexcept;

}  // namespace trussmap
