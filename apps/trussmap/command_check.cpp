// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap check: are recordings, or pose graphs, what they should be?
#include "command_line.hpp"
#include "commands.hpp"
#include "graph_options.hpp"
#include "model_recordings.hpp"
#include "results/checks.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "trussmap/check.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct CheckCommand {
  std::vector<std::string> inputs;
  std::string model;
  std::string json;
  std::string edge2 = kEdge2ByName;
  std::string mend;
};

void report(const CheckCommand& options, const std::vector<CheckFinding>& findings) {
  if (!options.json.empty())
    write_files({{options.json, results::json_text(results::CheckReport{findings})}});
  fmt::print("{}", check_text(findings, style_of(stdout)));
}

/// The recording as it should be, in a folder of its own.
void write_mended(const MendedRecording& whole, const std::string& folder) {
  std::string comment = "mended by trussmap check";
  for (const std::string& one : whole.notes) comment += "\n" + one;
  write_recording(folder, whole.recording, comment);
  for (const std::string& one : whole.notes) fmt::print("mended: {}\n", one);
  fmt::print("{}written: {}\n", whole.notes.empty() ? "nothing to mend; " : "", folder);
}

/// Whether nothing is found.
bool recordings_pass(const CheckCommand& options) {
  const std::vector<Recording> recordings = read_recordings(options.inputs, true);
  std::optional<Model> model;
  if (!options.model.empty()) model = read_model(options.model, recordings);
  const Model* const given = model ? &*model : nullptr;
  const std::vector<CheckFinding> findings =
      check_read_recordings(recordings, given, options.model);
  report(options, findings);
  if (!options.mend.empty()) write_mended(mended(recordings.front(), given), options.mend);
  return findings.empty();
}

bool graphs_pass(const CheckCommand& options) {
  if (!options.model.empty()) {
    throw UsageError("--model is given with pose graphs, expected with recordings: folders");
  }
  std::vector<CheckFinding> all;
  for (const std::string& file : options.inputs) {
    const PoseGraph graph = read_g2o(file, edge2_named(options.edge2), InformationOrder::either);
    const std::vector<CheckFinding> found = check_graph(graph, file);
    all.insert(all.end(), found.begin(), found.end());
  }
  report(options, all);
  return all.empty();
}

/// Whether the inputs are files, pose graphs therefore; recordings are folders.
bool are_graphs(const std::vector<std::string>& inputs) {
  const auto files = std::count_if(inputs.begin(), inputs.end(), [](const std::string& one) {
    return std::filesystem::is_regular_file(one);
  });
  if (files != 0 && files != std::ssize(inputs)) {
    throw UsageError("pose graphs and recordings are given, expected one or the other");
  }
  return files != 0;
}

void run_check(const CheckCommand& options, bool edge2_given) {
  const bool graphs = are_graphs(options.inputs);
  if (edge2_given && !graphs) {
    throw UsageError("--edge2 is given with recordings, expected with pose graphs: files");
  }
  if (!options.mend.empty() && (graphs || options.inputs.size() != 1)) {
    throw UsageError("--mend is given, expected with one recording: a folder");
  }
  if (!(graphs ? graphs_pass(options) : recordings_pass(options))) throw AnswerIsNo();
}

}  // namespace

void setup_check(const Command& app) {
  auto options = std::make_shared<CheckCommand>();
  const Command command =
      app.add_subcommand("check",
                         "Look for mistakes in recordings (units, signs, axes, names, clocks) or "
                         "in pose graphs (loops "
                         "the wrong way round, information, degrees, vertices that nothing ties)");
  command
      .add_option(
          "RECORDING", options->inputs,
          "Folders of CSV files, one per session; or files of pose graphs (g2o, TORO, iSAM), "
          "each by itself")
      .required()
      .type_name("DIR|FILE");
  command
      .add_option(
          "--model", options->model,
          "Model of the robot (TOML): its drive, and which columns are the wheels; without it, "
          "and without a compass, less is found")
      .type_name("FILE");
  command.add_option("--json", options->json, "Write the findings as JSON").type_name("FILE");
  add_edge2(command, options->edge2);
  command
      .add_option("--mend", options->mend,
                  "Write the recording without what can be put right by itself: counters that were "
                  "wrong in some samples, rows that stand twice, a clock that was set")
      .type_name("DIR");
  command.footer(
      "A line per finding: file, columns, what it is and what shows it, and below it the remedy.\n"
      "Exit status 0 where nothing is found, 1 where something is. The other commands print the\n"
      "same findings as warnings before they begin.");
  command.callback([options, command] { run_check(*options, command.count("--edge2") > 0); });
}

}  // namespace trussmap::app
