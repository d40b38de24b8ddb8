// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fleet: what many robots have in common, and which differ.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "results/fleet.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct AddCommand {
  std::string store;
  std::string robot;
  ModelRecordingsOptions input;
  std::string date;
  std::vector<std::string> metadata;
  bool replace = false;
};

struct MergeCommand {
  std::string out;
  std::vector<std::string> shards;
};

struct ReportCommand {
  std::string store;
  std::string json;
  double level = kSignificance;
  PageOptions page;
};

std::map<std::string, std::string> metadata_of(const std::vector<std::string>& pairs) {
  std::map<std::string, std::string> result;
  for (const std::string& pair : pairs) {
    const std::size_t at = pair.find('=');
    if (at == std::string::npos || at == 0 || at + 1 == pair.size()) {
      throw UsageError(fmt::format("--meta {}: expected KEY=VALUE", pair));
    }
    if (!result.emplace(pair.substr(0, at), pair.substr(at + 1)).second) {
      throw UsageError(fmt::format("--meta {}: is given twice", pair.substr(0, at)));
    }
  }
  return result;
}

std::string today() {
  return fmt::format(
      "{:%Y-%m-%d}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

void run_add(const AddCommand& options) {
  if (options.robot.empty()) throw UsageError("ROBOT is empty, expected a name");
  const std::string date = options.date.empty() ? today() : options.date;
  static_cast<void>(day_number(date));
  const std::map<std::string, std::string> metadata = metadata_of(options.metadata);
  const Session session = read_session(options.input);
  FleetRow row = fleet_row(options.robot, date, session.rows.recordings, session.model,
                           format_model(session.model), session.options.fit, session.options.legs);
  row.metadata = metadata;
  add_to_fleet(options.store, row, options.replace);
  fmt::print("{}: robot {} on {}, chi2 {:.1f} ({} dof), {} coefficients\n",
             escaped_controls(options.store), escaped_controls(row.robot), row.date, row.chi2,
             row.dof, row.columns.size());
  fmt::print("{}", notes_text(session.rows.notes));
}

void run_merge(const MergeCommand& options) {
  const std::size_t rows =
      merge_fleets(options.out, {options.shards.begin(), options.shards.end()});
  fmt::print("{}: {} {}\n", escaped_controls(options.out), rows,
             rows == 1 ? "day of a robot" : "days of robots");
}

void run_report(const ReportCommand& options) {
  const FleetReport report = fleet_report(read_fleet(options.store), options.level);
  Files files;
  if (!options.json.empty()) files.emplace_back(options.json, results::json_text(report));
  if (options.page.wanted()) add_page(files, fleet_page(report, options.store), options.page);
  files.write();
  const std::vector<std::string> lines = in_words(report);
  for (const std::string& line : lines) fmt::print("{}\n", escaped_controls(line));
  for (const std::string& note : report.notes) fmt::print("note: {}\n", note);
}

void setup_fleet_add(const Command& fleet) {
  auto options = std::make_shared<AddCommand>();
  const Command command = fleet.add_subcommand("add", "Add a robot's day to a fleet's store");
  command.add_option("FLEET", options->store, "Store of the fleet, made where it is not there")
      .required()
      .type_name("FILE");
  command.add_option("ROBOT", options->robot, "The robot's name").required().type_name("NAME");
  add_fitted_recordings(command, options->input);
  command.add_option("--date", options->date, "Its day (YYYY-MM-DD; else today, UTC)")
      .type_name("DATE");
  command
      .add_option("--meta", options->metadata,
                  "What effects may go with (tyre, floor, software); service=DATE: days of drift "
                  "count from there")
      .one_value_each()
      .type_name("KEY=VALUE");
  command.add_flag("--replace", options->replace,
                   "Replace that robot's day where it is there already");
  command.callback([options] { run_add(*options); });
}

void setup_fleet_merge(const Command& fleet) {
  auto options = std::make_shared<MergeCommand>();
  const Command command = fleet.add_subcommand("merge", "Add all days of other stores to a store");
  command.add_option("FLEET", options->out, "Store of the fleet, made where it is not there")
      .required()
      .type_name("FILE");
  command.add_option("SHARD", options->shards, "Stores whose days it gets, all or none")
      .required()
      .type_name("FILE");
  command.callback([options] { run_merge(*options); });
}

void setup_fleet_report(const Command& fleet) {
  auto options = std::make_shared<ReportCommand>();
  const Command command =
      fleet.add_subcommand("report", "Say what robots have in common, and which differ or drift");
  command.add_option("FLEET", options->store, "Store of the fleet").required().type_name("FILE");
  command.add_option("--json", options->json, "Write every figure as JSON").type_name("FILE");
  command.add_option("--level", options->level, "Level of significance of all that is said")
      .check(between(1e-6, 0.5))
      .capture_default_str();
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.callback([options] { run_report(*options); });
}

}  // namespace

void setup_fleet(const Command& app) {
  const Command command =
      app.add_subcommand("fleet", "Pool many robots: what is common, who differs, who drifts");
  setup_fleet_add(command);
  setup_fleet_merge(command);
  setup_fleet_report(command);
}

}  // namespace trussmap::app
