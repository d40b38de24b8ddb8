// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths of a command line, looked at before anything is read or written.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace trussmap::app {

/// Throws UsageError where a path is empty, or where a command would write over what it reads.
void check_paths(const CLI::App& command);

}  // namespace trussmap::app
