// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap reveal: what simulate --hide has hidden.
#include "commands.hpp"
#include "effect_options.hpp"
#include "sealed_answer.hpp"
#include "terminal.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

struct RevealOptions {
  std::string folder;
  std::string json;
};

void run_reveal(const RevealOptions& options) {
  const nlohmann::ordered_json answer = opened(options.folder);
  if (!options.json.empty()) write_file(options.json, answer.dump(2) + "\n");
  fmt::print("revealed: what is hidden in {}\n\n{}", options.folder,
             effects_text(effects_from(answer.at("effects")), style_of(stdout)));
}

}  // namespace

void setup_reveal(const Command& app) {
  auto options = std::make_shared<RevealOptions>();
  const Command command =
      app.add_subcommand("reveal", "Open the answer that simulate --hide sealed: the effects.");
  command.add_option("FOLDER", options->folder, "Recording that simulate --hide wrote")
      .required()
      .type_name("DIR");
  command.add_option("--json", options->json, "Write the answer as JSON").type_name("FILE");
  command.callback([options] { run_reveal(*options); });
}

}  // namespace trussmap::app
