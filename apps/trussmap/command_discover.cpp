// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap discover: diagnose, add and fit for as long as that is justified.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "next_step.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "results/criticism.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "tolerance_option.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <memory>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct DiscoverCommand {
  ModelRecordingsOptions input;
  std::string out;
  std::size_t most = 6;
  PageOptions page;
  std::string tolerance;
};

/// Tells how far a discovery is: as if one effect were found, and one more whenever there is.
class Told {
 public:
  explicit Told(bool page) : progress_(steps(page)) { progress_.next(); }

  void part(const DiscoveryStage& stage) {
    const bool fits = stage.kind == DiscoveryStage::Kind::fitting_effect;
    const bool rival = fits && fits_;  // in the same step
    fits_ = fits;
    if (fits && !rival && ++found_ > 1) progress_.insert(one_more_effect());
    if (!rival) progress_.next();
    if (fits) progress_.say(fmt::format("fitting \"{}\"", stage.effect));
  }
  void page() {
    // Where nothing was found, the two steps of an effect are passed over.
    for (int k = found_ == 0 ? 0 : 2; k < 3; ++k) progress_.next();
  }
  void end() { progress_.end(); }

 private:
  /// The last two stages: an effect, and what is missing then.
  static std::vector<Stage> one_more_effect() {
    const std::vector<Stage> stages = discover_stages();
    return {stages.end() - 2, stages.end()};
  }
  static std::vector<Stage> steps(bool page) {
    std::vector<Stage> result = discover_stages();
    if (page) result.push_back({"comparing the models", 60});
    return result;
  }

  Progress progress_;
  bool fits_ = false;
  int found_ = 0;
};

void run_discover(const DiscoverCommand& options) {
  Told told(options.page.wanted());
  Session session = read_session(options.input);
  session.options.most_effects = options.most;
  const DiscoveryReport report =
      discover(session, [&told](const DiscoveryStage& stage) { told.part(stage); });
  told.page();
  const std::optional<Tolerance> tolerance = judged(options.tolerance, report.found.last.held_out);
  const bool kept = !options.out.empty();
  const std::optional<NextStep> next = next_step(next_command(report.found, kept), options.input,
                                                 kept ? options.out : options.input.model);
  Files files;
  if (kept) files.emplace_back(options.out, format_model(report.found.found.model));
  if (!options.input.json.empty()) {
    files.emplace_back(options.input.json, results::json_text(results::Reported<DiscoveryReport>{
                                               &report, &session.rows.notes, tolerance}));
  }
  if (options.page.wanted()) {
    const Page found = discovery_page(
        report.found,
        evidence_of(session.rows.recordings, report.found, diagnose_options(session.options)),
        subject_of(options.input.recordings, options.input.model));
    const Page page = with_next(found, next);
    add_page(files,
             with_tolerance(with_drive(with_constants(page, report.constants), session.model.robot,
                                       session.rows.recordings),
                            tolerance),
             options.page, session.rows.recordings);
  }
  files.write();
  told.end();
  fmt::print(
      "{}{}{}{}",
      discovery_text(report.found, session.model.noise, report.noise_budget, style_of(stdout)),
      constants_text(report.constants, style_of(stdout)), notes_text(session.rows.notes),
      next_text(next));
  end_by(tolerance);
}

}  // namespace

void setup_discover(const Command& app) {
  auto options = std::make_shared<DiscoverCommand>();
  const Command command = app.add_subcommand(
      "discover", "Find the effects that a model is missing, add and fit them, one by one");
  add_model_recordings(command, options->input);
  add_stated_noise(command, options->input);
  command.add_option("--out", options->out, "Write the model found (TOML)").type_name("FILE");
  command.add_option("--most", options->most, "Effects to add at most").capture_default_str();
  add_tolerance(command, options->tolerance);
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "The table has one line per model, always over the same held-out legs. \"predicted\" is "
      "what\n"
      "the diagnosis predicted before the fit. The page (--html) adds each effect's curve.");
  command.callback([options] { run_discover(*options); });
}

}  // namespace trussmap::app
