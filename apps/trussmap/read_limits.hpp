// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --max-input-mib and --max-nesting, the same for all commands that read files.
#pragma once

#include <CLI/CLI.hpp>

namespace trussmap::app {

/// After the commands have been added.
void add_read_limits(CLI::App& app);

}  // namespace trussmap::app
