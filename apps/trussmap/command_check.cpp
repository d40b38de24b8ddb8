// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap check: are recordings what they should be?
#include "command_line.hpp"
#include "commands.hpp"
#include "model_recordings.hpp"
#include "terminal.hpp"
#include "trussmap/check.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
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
  std::string mend;
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

/// The recording as it should be, in a folder of its own.
void write_mended(const CheckCommand& options, const Model* model) {
  const MendedRecording whole = mended(read_recording(options.recordings.front()), model);
  std::string comment = "mended by trussmap check";
  for (const std::string& one : whole.notes) comment += "\n" + one;
  write_recording(options.mend, whole.recording, comment);
  for (const std::string& one : whole.notes) fmt::print("mended: {}\n", one);
  fmt::print("{}written: {}\n", whole.notes.empty() ? "nothing to mend; " : "", options.mend);
}

void run_check(const CheckCommand& options) {
  if (!options.mend.empty() && options.recordings.size() != 1) {
    throw InputError("--mend " + options.mend, 0,
                     fmt::format("{} recordings are given, expected one: a folder holds one",
                                 options.recordings.size()));
  }
  const std::vector<Recording> recordings = read_recordings(options.recordings);
  std::optional<Model> model;
  if (!options.model.empty()) model = read_model(options.model, recordings);
  const std::vector<CheckFinding> findings =
      check_read_recordings(recordings, model ? &*model : nullptr, options.model);
  if (!options.json.empty()) write_files({{options.json, json_text(findings)}});
  fmt::print("{}", check_text(findings, style_of(stdout)));
  if (!options.mend.empty()) write_mended(options, model ? &*model : nullptr);
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
  command
      .add_option("--mend", options->mend,
                  "Write the recording without what can be put right by itself: counters that were "
                  "wrong in some samples, rows that stand twice, a clock that was set")
      .type_name("DIR");
  command.footer(
      "A line per finding: file, columns, what it is and what shows it, and below it the remedy.\n"
      "Exit status 0 where nothing is found, 1 where something is. The other commands print the\n"
      "same findings as warnings before they begin.");
  command.callback([options] { run_check(*options); });
}

}  // namespace trussmap::app
