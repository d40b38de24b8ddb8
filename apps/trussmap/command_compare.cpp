// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap compare: how far a model is from measurements, and where.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "next_step.hpp"
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
  Progress progress(compare_stages());
  progress.next();
  const Session session = read_session(options.input);
  const ComparisonReport report = compare(session, [&progress] { progress.next(); });
  const std::optional<Tolerance> tolerance = judged(options.tolerance, report.found.held_out);
  const std::optional<NextStep> next =
      next_step(next_command(report.found), options.input, options.input.model);
  Files files;
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, results::json_text(results::Reported<ComparisonReport>{
                                               &report, &session.rows.notes, tolerance}));
  }
  if (options.page.wanted()) {
    const std::string subject = subject_of(options.input.recordings, options.input.model);
    const Page page =
        with_next(comparison_page(evidence_of(report.fit, report.found), subject), next);
    add_page(
        files,
        with_tolerance(with_drive(page, session.model.robot, session.rows.recordings), tolerance),
        options.page, session.rows.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}{}",
             comparison_text(report.found, session.model.noise, report.noise_budget, options.worst,
                             style_of(stdout)),
             notes_text(session.rows.notes), next_text(next));
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
