// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags, team logs and tables: what is in one, and one as a recording.
#pragma once

#include <filesystem>
#include <string>

namespace trussmap::app {

/// Prints what is in the log and writes a first map.toml. Throws UsageError where that file is
/// there already.
void inspect_log_file(const std::filesystem::path& log, const std::filesystem::path& map);

/// Writes the recording and its model.toml, and says what came of the log.
void convert_log(const std::filesystem::path& log, const std::filesystem::path& out,
                 const std::filesystem::path& map);

}  // namespace trussmap::app
