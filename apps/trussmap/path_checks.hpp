// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths of a command line, looked at before anything is read or written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace trussmap::app {

/// Throws UsageError where a path is empty, or where a command would write over what it reads.
void check_paths(const CLI::App& command);

/// Of one that has no option of its own. Throws UsageError where it is what `option` reads.
void check_output(const std::filesystem::path& out, const std::string& option,
                  const std::vector<std::filesystem::path>& read);

}  // namespace trussmap::app
