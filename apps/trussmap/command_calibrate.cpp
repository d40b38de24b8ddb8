// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap calibrate: wheels, wheelbase and wheel noise from recordings with truth, fixes or a
// survey.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "recording_warnings.hpp"
#include "results/calibration.hpp"
#include "results/common.hpp"
#include "results/json.hpp"
#include "terminal.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct CalibrateOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string out;
  std::string json;
  CalibrationOptions calibration;
  std::vector<std::string> test;
  std::vector<std::string> without;
  PageOptions page;
};

CalibrationOptions calibration_options(const CalibrateOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  CalibrationOptions result = options.calibration;
  result.survey = !left_out("survey");
  result.truth = !left_out("truth");
  result.fixes = !left_out("fixes");
  return result;
}

TestedDrives tested(const std::vector<DrivenRecording>& recordings, const Model& nominal,
                    const WheelCalibration& found) {
  TestedDrives result;
  for (const DrivenRecording& one : recordings) result.names.push_back(one.name);
  result.nominal = drive_errors(recordings, nominal);
  result.calibrated = drive_errors(recordings, found.model, found.truth);
  return result;
}

void run_calibrate(const CalibrateOptions& options) {
  Progress progress({{"reading", 10}, {"calibrating", 45}, {"predicting held-out legs", 45}});
  progress.next();
  const std::vector<Recording> read = read_recordings(options.recordings);
  const Model model = read_model(options.model, read);
  const std::vector<DrivenRecording> recordings = with_wheels(read, model.robot);
  const std::vector<DrivenRecording> test_drives =
      with_wheels(read_recordings(options.test), model.robot);
  warn_of_mistakes(read, model, options.model);
  WheelCalibration found;
  CalibrationValidation held;
  std::optional<TestedDrives> test;
  const CalibrationOptions how = calibration_options(options);
  try {
    progress.next();
    found = calibrate_wheels(recordings, model, how);
    progress.next();
    held = validate_calibration(recordings, model, how);
    if (!test_drives.empty()) test = tested(test_drives, model, found);
  } catch (const std::invalid_argument& error) {
    throw InputError(options.model, 0, error.what());
  }
  const RobotConstants constants =
      with_velocity_variances(robot_constants(model, found), recordings, found.model);
  Files files;
  if (!options.out.empty()) {
    files.emplace_back(options.out, format_model(with_wheelbase_in_robot(found.model)));
  }
  if (!options.json.empty()) {
    const results::CalibrationReport report{&found, &held, &test};
    files.emplace_back(
        options.json,
        results::json_text(results::WithConstants<results::CalibrationReport>{report, &constants}));
  }
  if (options.page.wanted()) {
    const Page page =
        truth_page({found, held.nominal, held.calibrated, calibration_verdict(found, held)},
                   subject_of(options.recordings, options.model));
    add_page(files, with_drive(with_constants(page, constants), model.robot, recordings),
             options.page, recordings);
  }
  files.write();
  progress.end();
  fmt::print("{}{}", calibration_text(found, held, test, style_of(stdout)),
             constants_text(constants, style_of(stdout)));
}

}  // namespace

void setup_calibrate(const Command& app) {
  auto options = std::make_shared<CalibrateOptions>();
  const Command command = app.add_subcommand("calibrate",
                                             "Calibrate wheels, wheelbase and wheel noise from "
                                             "recordings with truth, fixes, a survey, or a "
                                             "second odometer's motions (loops)");
  command.add_option("RECORDING", options->recordings, "Folders of CSV files, one per session")
      .required()
      .type_name("DIR");
  command.add_option("--model", options->model, "Model to start from (TOML)")
      .required()
      .type_name("FILE");
  command.add_option("--out", options->out, "Write the model with what was found (TOML)")
      .type_name("FILE");
  command.add_option("--json", options->json, "Write every figure as JSON").type_name("FILE");
  command
      .add_option("--holdout", options->calibration.holdout,
                  "Share of the legs with truth that are held out to judge the calibration by; "
                  "with a few short recordings each is held out in turn (0: none)")
      .check(between(0.0, 0.9))
      .capture_default_str();
  command.add_option("--leg", options->calibration.leg, "Length of such a leg [m of driven path]")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option("--test", options->test,
                  "Recordings with truth, not calibrated by, to test the calibration on")
      .type_name("DIR");
  command
      .add_option("--without", options->without, "Do not use the survey, the truth, or the fixes")
      .delimiter(',')
      .check(one_of({"survey", "truth", "fixes"}))
      .type_name("WHAT,...");
  command
      .add_option("--gate", options->calibration.gate,
                  "Leave the few sightings, fixes and loops out that all others contradict by more "
                  "standard deviations than this, where the rest fit far better (0: leave none "
                  "out)")
      .check(zero_or_more())
      .capture_default_str();
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "E_d and E_s become the model's effects wheel diameter ratio and wheel scale, E_b its\n"
      "wheelbase in [robot]. Standard errors hold for the noise that the model states for truth, "
      "survey and\n"
      "sightings; chi2/dof should be near 1. Where truth and fixes track the robot, and how "
      "late, is\n"
      "found too.\n"
      "\n"
      "--test dead-reckons each recording from its first truth pose to its last, with the given\n"
      "model (nominal) and with the calibrated one: how far the end is off, and how far the "
      "change\n"
      "of heading, per metre of the wheels' mean travel (so that turns on the spot count).");
  command.callback([options] { run_calibrate(*options); });
}

}  // namespace trussmap::app
