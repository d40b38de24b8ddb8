// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Command lines to be printed: as it was called, with other values for some options, and others.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace trussmap::app {

void remember_call(int argc, char** argv);

/// "trussmap simulate --mesh 4x4 --seed 6 ...": what was remembered, these options' values replaced
/// or added, words quoted for a shell where they have to be.
[[nodiscard]] std::string call_with(
    const std::vector<std::pair<std::string, std::string>>& options);

/// One word of a shell's command line, whatever is in it.
[[nodiscard]] std::string shell_quoted(const std::string& word);

/// "trussmap build rec --model robot.toml", words quoted for a shell where they have to be.
[[nodiscard]] std::string call_of(const std::vector<std::string>& words);

/// "riddle-2" for "riddle", "riddle-3" for "riddle-2".
[[nodiscard]] std::string next_name(const std::string& name);

}  // namespace trussmap::app
