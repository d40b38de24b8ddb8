// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The commands and their options as words: for manual pages and for shells, which complete them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace trussmap::app {

struct OptionWords {
  std::vector<std::string> names;  ///< "-h", "--help"; of an argument "RECORDING"
  bool is_argument = false;
  std::string value;                 ///< "FILE", "{a,b}", "X=0.05"; empty: a flag
  std::vector<std::string> choices;  ///< a and b
  std::string description;
};

struct CommandWords {
  std::string name;
  std::string description;
  std::string usage;   ///< "RECORDING... --model FILE [OPTIONS]"
  std::string footer;  ///< as help has it, lines broken
  std::vector<OptionWords> options;
  std::vector<CommandWords> commands;
};

/// Options that all commands share are those of the whole.
[[nodiscard]] CommandWords words_of(const CLI::App& app);

/// In roff, of the whole ("trussmap") or one command by its words ("fleet add"): the page's name
/// ("trussmap-fleet-add.1") and its text. Sub-commands have pages of their own.
struct ManualPage {
  std::string file;
  std::string text;
};
[[nodiscard]] std::vector<ManualPage> manual_pages(const CommandWords& whole,
                                                   const std::string& version);

// What completes the commands in a shell.

[[nodiscard]] std::string bash_completion(const CommandWords& whole);
[[nodiscard]] std::string zsh_completion(const CommandWords& whole);
[[nodiscard]] std::string fish_completion(const CommandWords& whole);

}  // namespace trussmap::app
