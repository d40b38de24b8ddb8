// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap diagnose: which physical effect is missing from a model.
#include "commands.hpp"
#include "floor_maps.hpp"
#include "model_recordings.hpp"
#include "next_step.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "results/criticism.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct DiagnoseCommand {
  ModelRecordingsOptions input;
  std::size_t list = 8;
  PageOptions page;
  std::string tolerance;
  std::string floor_map;
};

void run_diagnose(const DiagnoseCommand& options) {
  std::vector<Stage> stages = diagnose_stages();
  if (options.page.wanted()) stages.push_back({"comparing with what is missing", 50});
  Progress progress(stages);
  progress.next();
  Session session = read_session(options.input);
  const DiagnosisReport report = diagnose(session, [&progress] { progress.next(); });
  const std::optional<Tolerance> tolerance = judged(options.tolerance, report.found.held_out);
  const std::optional<NextStep> next =
      next_step(next_command(report.found), options.input, options.input.model);
  Files files;
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, results::json_text(results::Reported<DiagnosisReport>{
                                               &report, &session.rows.notes, tolerance}));
  }
  progress.next();
  if (options.page.wanted()) {
    const Page found = diagnosis_page(report.found,
                                      evidence_of(session.rows.recordings, report.fit, report.found,
                                                  diagnose_options(session.options)),
                                      subject_of(options.input.recordings, options.input.model));
    const Page page = with_next(found, next);
    add_page(files,
             with_tolerance(with_drive(with_constants(page, report.constants), session.model.robot,
                                       session.rows.recordings),
                            tolerance),
             options.page, session.rows.recordings);
  }
  add_floor_maps(files, report.found.places, options.floor_map);
  files.write();
  progress.end();
  fmt::print("{}{}{}{}{}",
             diagnosis_text(report.found, report.noise_budget, options.list, style_of(stdout)),
             constants_text(report.constants, style_of(stdout)),
             floor_maps_text(report.found.places, options.floor_map),
             notes_text(session.rows.notes), next_text(next));
  end_by(tolerance);
}

}  // namespace

void setup_diagnose(const Command& app) {
  auto options = std::make_shared<DiagnoseCommand>();
  const Command command =
      app.add_subcommand("diagnose", "Find out which physical effect a model is missing");
  add_model_recordings(command, options->input);
  add_stated_noise(command, options->input);
  command.add_option("--list", options->list, "Candidates to list").capture_default_str();
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  add_floor_map_option(command, options->floor_map);
  command.footer(
      "Tries the whole catalogue, and every channel against every variable and covariate. "
      "Missing:\n"
      "named by these data. Absent: would have been seen at any size that matters. Cannot tell:\n"
      "these data could not show it, or another effect looks the same. The page (--html) has what\n"
      "is missing, its rivals, the next drive, and the best change to each part of the robot.");
  command.callback([options] { run_diagnose(*options); });
}

}  // namespace trussmap::app
