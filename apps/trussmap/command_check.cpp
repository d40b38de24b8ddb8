// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap check: are recordings what they should be?
#include "command_line.hpp"
#include "commands.hpp"
#include "model_recordings.hpp"
#include "terminal.hpp"
#include "trussmap/check.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct CheckCommand {
  std::vector<std::string> recordings;
  std::string model;
  std::string json;
};

std::string json_text(const std::vector<CheckFinding>& findings) {
  ordered_json list = ordered_json::array();
  for (const CheckFinding& one : findings) {
    list.push_back({{"file", one.file},
                    {"column", one.column},
                    {"kind", one.kind},
                    {"evidence", one.evidence},
                    {"remedy", one.remedy}});
  }
  return ordered_json{{"findings", list}}.dump(2) + "\n";
}

void run_check(const CheckCommand& options) {
  const std::vector<Recording> recordings = read_recordings(options.recordings);
  std::optional<Model> model;
  if (!options.model.empty()) model = read_model(options.model, recordings);
  const std::vector<CheckFinding> findings =
      check_recordings(recordings, model ? &*model : nullptr, options.model);
  if (!options.json.empty()) write_files({{options.json, json_text(findings)}});
  fmt::print("{}", check_text(findings, style_of(stdout)));
  if (!findings.empty()) throw AnswerIsNo();
}

}  // namespace

void setup_check(const Command& app) {
  auto options = std::make_shared<CheckCommand>();
  const Command command = app.add_subcommand(
      "check", "Look for mistakes in recordings: units, signs, axes, names, clocks");
  command.add_option("RECORDING", options->recordings, "Folders of CSV files, one per session")
      .required()
      .type_name("DIR");
  command
      .add_option(
          "--model", options->model,
          "Model of the robot (TOML): its drive, and which columns are the wheels; without it, "
          "and without a compass, less is found")
      .type_name("FILE");
  command.add_option("--json", options->json, "Write the findings as JSON").type_name("FILE");
  command.footer(
      "A line per finding: file, columns, what it is and what shows it, and below it the remedy.\n"
      "Exit status 0 where nothing is found, 1 where something is. The other commands print the\n"
      "same findings as warnings before they begin.");
  command.callback([options] { run_check(*options); });
}

}  // namespace trussmap::app
