// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags, team logs and tables: what is in one, and one, or several
// that belong together, as a recording.
#pragma once

#include "trussmap/log_files.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace trussmap::app {

/// Prints what is in the logs, and of several which clock is which, and writes a first map.toml.
/// Throws UsageError where that file is there already.
void inspect_log_files(const std::vector<std::filesystem::path>& logs,
                       const std::filesystem::path& map, const LogOptions& options);

/// Writes the recording and its model.toml, and says what came of the logs.
void convert_logs(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& out,
                  const std::filesystem::path& map, const LogOptions& options);

}  // namespace trussmap::app
