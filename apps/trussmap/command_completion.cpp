// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap completion, trussmap manual: what shells and man take.
#include "command_words.hpp"
#include "commands.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct ManualCommand {
  std::string out;
};

}  // namespace

void setup_completion(const Command& app, const CLI::App& whole) {
  auto shell = std::make_shared<std::string>();
  const Command command =
      app.add_subcommand("completion", "Print what completes the commands in a shell");
  command.add_option("SHELL", *shell, "bash: source <(trussmap completion bash)")
      .required()
      .check(one_of({"bash", "zsh", "fish"}));
  command.callback([shell, &whole] {
    const CommandWords words = words_of(whole);
    fmt::print("{}", *shell == "bash"  ? bash_completion(words)
                     : *shell == "zsh" ? zsh_completion(words)
                                       : fish_completion(words));
  });
}

void setup_manual(const Command& app, const CLI::App& whole) {
  auto options = std::make_shared<ManualCommand>();
  const Command command = app.add_subcommand("manual", "Write the manual pages, for man");
  command.add_option("--out", options->out, "Folder for them, one per command")
      .required()
      .type_name("DIR");
  command.callback([options, &whole] {
    std::vector<std::pair<std::string, std::string>> files;
    for (ManualPage& page : manual_pages(words_of(whole), TRUSSMAP_VERSION)) {
      files.emplace_back(std::move(page.file), std::move(page.text));
    }
    write_files({}, {{options->out, files, {}}});
    fmt::print("{} pages in {}\n", files.size(), options->out);
  });
}

}  // namespace trussmap::app
