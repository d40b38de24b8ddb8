// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap contrast: what changed between two runs of one robot.
#include "command_line.hpp"
#include "commands.hpp"
#include "page_runtime.hpp"
#include "results/fleet.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct ContrastCommand {
  std::string before;
  std::string now;
  std::string json;
  double level = kSignificance;
  PageOptions page;
};

void run_contrast(const ContrastCommand& options) {
  const RunContrast contrast =
      contrast_runs(read_run_figures(options.before), read_run_figures(options.now), options.level);
  Files files;
  if (!options.json.empty()) files.emplace_back(options.json, results::json_text(contrast));
  if (options.page.wanted()) {
    add_page(files, contrast_page(contrast, options.before + ", then " + options.now),
             options.page);
  }
  files.write();
  fmt::print("{}", contrast_text(contrast, style_of(stdout)));
}

}  // namespace

void setup_contrast(const Command& app) {
  auto options = std::make_shared<ContrastCommand>();
  const Command command = app.add_subcommand(
      "contrast", "Say what changed between two runs of one robot, before and after a repair");
  command.add_option("BEFORE", options->before, "JSON of the run before")
      .required()
      .type_name("FILE");
  command.add_option("NOW", options->now, "JSON of the run now").required().type_name("FILE");
  command.add_option("--level", options->level, "Level of significance of all that is said")
      .check(between(1e-6, 0.5))
      .capture_default_str();
  command.add_option("--json", options->json, "Write every figure as JSON").type_name("FILE");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "BEFORE and NOW are what compare, fit, diagnose, discover or calibrate wrote with --json, "
      "of\n"
      "two recordings: the errors, the robot's constants and the effects that both tell. Fit the\n"
      "same model to both, or calibrate both, so that both tell the same.");
  command.callback([options] { run_contrast(*options); });
}

}  // namespace trussmap::app
