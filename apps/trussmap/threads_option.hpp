// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --threads, the same for all commands.
#pragma once

#include <CLI/CLI.hpp>

namespace trussmap::app {

/// After the commands have been added. Sets the default, too: a thread per processor.
void add_threads_option(CLI::App& app);

}  // namespace trussmap::app
