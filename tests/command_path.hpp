// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the command is that tests run.
#pragma once

#include <cstdlib>
#include <string>

namespace trussmap::testing {

/// That of the build tree; another one where the environment names it (TRUSSMAP_COMMAND).
inline std::string command_path() {
  const char* another = std::getenv("TRUSSMAP_COMMAND");
  return another != nullptr ? another : TRUSSMAP_COMMAND;
}

}  // namespace trussmap::testing
