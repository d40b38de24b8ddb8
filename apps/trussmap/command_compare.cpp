// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap compare: how far a model is from measurements, and where.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "results/criticism.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct CompareCommand {
  ModelRecordingsOptions input;
  std::size_t worst = 5;
  PageOptions page;
  std::string tolerance;
};

void run_compare(const CompareCommand& options) {
  Progress progress({{"reading", 1}, {"fitting the map", 4}, {"comparing", 40}});
  progress.next();
  const ModelRecordings input = read_model_recordings(options.input);
  CompareOptions how = compare_options(options.input);
  how.fit.fit_effects = false;
  progress.next();
  const ModelFit fit = fit_model(input.recordings, input.model, how.fit);
  progress.next();
  const Comparison result = compare(input, fit, how);
  const std::vector<NoiseBudget> budget = noise_budget(input.recordings, input.model);
  const std::optional<Tolerance> tolerance = judged(options.tolerance, result.held_out);
  Files files;
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, results::json_text(results::Reported<Comparison>{
                                               &result, &budget, &input.notes, tolerance}));
  }
  if (options.page.wanted()) {
    add_page(
        files,
        with_tolerance(
            with_drive(comparison_page(evidence_of(fit, result),
                                       subject_of(options.input.recordings, options.input.model)),
                       input.model.robot, input.recordings),
            tolerance),
        options.page, input.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}",
             comparison_text(result, input.model.noise, budget, options.worst, style_of(stdout)),
             notes_text(input.notes));
  end_by(tolerance);
}

}  // namespace

void setup_compare(const Command& app) {
  auto options = std::make_shared<CompareCommand>();
  const Command command = app.add_subcommand(
      "compare", "Compare a model with recordings: is it consistent, and where does it fail?");
  add_model_recordings(command, options->input);
  command.add_option("--worst", options->worst, "Legs and routes to list").capture_default_str();
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Survey and truth are used as measurements. A bar force is what a route pulls (+) or pushes\n"
      "(-) its landmarks with. JSON holds all legs, routes and trends.");
  command.callback([options] { run_compare(*options); });
}

}  // namespace trussmap::app
