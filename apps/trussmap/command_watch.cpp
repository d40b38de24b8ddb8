// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap watch: a recording leg by leg through the monitor that a robot has on board.
#include "command_line.hpp"
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "results/json.hpp"
#include "results/watch.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/monitor.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct WatchCommand {
  std::string recording;
  std::string model;
  std::string json;
  std::vector<std::string> without;
  WatchOptions how;
};

bool leaves_out(const WatchCommand& options, const std::string& what) {
  return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
}

void run_watch(const WatchCommand& options) {
  std::vector<Recording> recordings = read_recordings({options.recording});
  const Model model = read_model(options.model, recordings);
  Recording& recording = recordings.front();
  if (leaves_out(options, "survey")) recording.survey.clear();
  if (leaves_out(options, "truth")) recording.truth.clear();
  if (leaves_out(options, "fixes")) recording.fixes.clear();
  const auto watched = [&] {
    try {
      return watch(recording, model, options.how);
    } catch (const std::invalid_argument& error) {
      throw InputError(options.recording, 0, error.what());
    }
  };
  const Watch result = watched();
  const double rate = options.how.monitor.false_alarms_per_hour;
  if (!options.json.empty()) {
    write_files({{options.json, results::json_text(results::WatchReport{&result, rate})}});
  }
  fmt::print("{}", watch_text(result, rate, style_of(stdout)));
  if (result.passed_over > 0) {
    fmt::print("{}", notes_text({fmt::format("{} sightings by a range or a bearing alone are "
                                             "passed over",
                                             result.passed_over)}));
  }
  if (result.alarm) throw AnswerIsNo();
}

}  // namespace

void setup_watch(const Command& app) {
  auto options = std::make_shared<WatchCommand>();
  const Command command = app.add_subcommand(
      "watch",
      "Drive a recording leg by leg with the robot's monitor: when did the model cease to "
      "hold?");
  command.add_option("RECORDING", options->recording, "Folder of CSV files")
      .required()
      .type_name("DIR");
  command.add_option("--model", options->model, "Model of the robot (TOML)")
      .required()
      .type_name("FILE");
  command
      .add_option("--rate", options->how.monitor.false_alarms_per_hour,
                  "False alarms an hour of driving, at most, whenever one looks")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--margin", options->how.monitor.noise_margin,
                  "How much larger the noise may be than the model states, for the rate to hold; 1 "
                  "or more")
      .check(between(1.0, 10.0))
      .capture_default_str();
  command
      .add_option("--landmarks", options->how.monitor.landmarks,
                  "Landmarks seen last that the monitor keeps")
      .check(whole_number(2))
      .capture_default_str();
  command
      .add_option("--min-drive", options->how.min_drive,
                  "Shortest leg between two landmarks [m of driven path]")
      .check(zero_or_more())
      .capture_default_str();
  command
      .add_option("--leg", options->how.leg,
                  "Length of a leg that ends at a fix or a truth row [m of driven path]")
      .check(above_zero())
      .capture_default_str();
  command.add_option("--without", options->without, "Do not use the survey, the truth, or fixes")
      .delimiter(',')
      .check(one_of({"survey", "truth", "fixes"}))
      .type_name("WHAT,...");
  command
      .add_option("--json", options->json,
                  "Write every figure as JSON, with the evidence after "
                  "each leg")
      .type_name("FILE");
  command.footer(
      "Nothing after a leg is used to judge it. Noise larger than the model states raises alarms: "
      "estimate\nit before, from a drive that was in order (fit --noise). Exit status 0 where the "
      "model held, 1 where\nthere is an alarm.");
  command.callback([options] { run_watch(*options); });
}

}  // namespace trussmap::app
