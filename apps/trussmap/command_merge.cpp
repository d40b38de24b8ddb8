// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap merge: the whole run, out of the files of its shards.
#include "commands.hpp"
#include "tour_shards.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

struct MergeOptions {
  std::vector<std::string> shards;
  TourOutput output;
};

void run_merge(const MergeOptions& options) {
  std::vector<std::pair<std::string, ShardResults>> shares;
  for (const std::string& path : options.shards) {
    shares.emplace_back(path, parse_shard_results(read_file(path), path));
  }
  const ShardResults whole = merge_shards(shares);
  if (whole.program != kTourProgram) {
    throw InputError(options.shards.front(), 0,
                     fmt::format("is a shard of {0}, expected one of {1}: merge it by {0} --merge",
                                 whole.program, kTourProgram));
  }
  try {
    show_tour_run(whole, options.output);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(options.shards.front(), 0,
                     fmt::format("is a damaged shard: {}", error.what()));
  }
}

}  // namespace

void setup_merge(const Command& app) {
  auto options = std::make_shared<MergeOptions>();
  const Command command = app.add_subcommand(
      "merge", "Put the shards of a tour together: print and write what the whole run would have");
  command.add_option("SHARD", options->shards, "Files that tour --shard has written, in any order")
      .required()
      .type_name("FILE");
  command.add_option("--json", options->output.json_file, "Write every figure as JSON")
      .type_name("FILE");
  add_html_option(command, options->output.page);
  add_plots_option(command, options->output.page);
  command.callback([options] { run_merge(*options); });
}

}  // namespace trussmap::app
