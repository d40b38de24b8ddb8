// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fit: the coefficients of a model's effects.
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
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>
#include <optional>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct FitCommand {
  ModelRecordingsOptions input;
  std::string out;
  bool noise = false;
  PageOptions page;
  std::string tolerance;
};

void run_fit(const FitCommand& options) {
  std::vector<Stage> stages = fit_stages(options.noise);
  if (options.page.wanted()) stages.push_back({"comparing both", 50});
  Progress progress(stages);
  progress.next();
  const Session session = read_session(options.input);
  if (session.model.effects.empty() && !options.noise) {
    throw UsageError(options.input.model +
                     " has no effect to fit, expected one or more (see trussmap add)");
  }
  const FitReport report = fit(session, options.noise, [&progress] { progress.next(); });
  const std::optional<Tolerance> tolerance = judged(options.tolerance, report.gain.held_out_with);
  Files files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(report.gain.with.model));
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, results::json_text(results::Reported<FitReport>{
                                               &report, &session.rows.notes, tolerance}));
  }
  progress.next();
  if (options.page.wanted()) {
    FitEvidence evidence =
        evidence_of(session.rows.recordings, report.gain, compare_options(session.options));
    if (report.noise) evidence.noise = in_words(*report.noise);
    const std::string subject = subject_of(options.input.recordings, options.input.model);
    add_page(
        files,
        with_tolerance(with_drive(with_constants(fit_page(evidence, subject), report.constants),
                                  session.model.robot, session.rows.recordings),
                       tolerance),
        options.page, session.rows.recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}{}", fit_text(report.gain, report.noise, style_of(stdout)),
             constants_text(report.constants, style_of(stdout)), notes_text(session.rows.notes));
  end_by(tolerance);
}

}  // namespace

void setup_fit(const Command& app) {
  auto options = std::make_shared<FitCommand>();
  const Command command =
      app.add_subcommand("fit", "Estimate the coefficients of a model's effects from recordings");
  add_model_recordings(command, options->input);
  command.add_option("--out", options->out, "Write the model with its coefficients (TOML)")
      .type_name("FILE");
  command.add_flag("--noise", options->noise,
                   "Estimate the noise, too: the size of every source, and which part of it lasts");
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "Effects without coefficients start at 0. A coefficient that these recordings cannot show "
      "is\n"
      "left as it was, and named. The held-out figures are those of a fit without these legs.");
  command.callback([options] { run_fit(*options); });
}

}  // namespace trussmap::app
