// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap calibrate: wheels, wheelbase and wheel noise from recordings with truth or survey.
#include "commands.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "recording_warnings.hpp"
#include "terminal.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

constexpr double kFarTooLarge = 2.0;  // chi^2/dof: more than any choice of noise explains

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

/// Dead reckoning of drives that the calibration has not seen.
struct Tested {
  std::vector<std::string> names;
  std::vector<DriveError> nominal;
  std::vector<DriveError> calibrated;
};

CalibrationOptions calibration_options(const CalibrateOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  CalibrationOptions result = options.calibration;
  result.survey = !left_out("survey");
  result.truth = !left_out("truth");
  return result;
}

Tested tested(const std::vector<Recording>& recordings, const Model& nominal,
              const WheelCalibration& found) {
  Tested result;
  for (const Recording& one : recordings) result.names.push_back(one.name);
  result.nominal = drive_errors(recordings, nominal);
  result.calibrated = drive_errors(recordings, found.model, found.truth);
  return result;
}

ordered_json json(const Tested& test) {
  ordered_json out = {{"recordings", test.names.size()},
                      {"end_rms_m", rms_end(test.calibrated)},
                      {"end_rms_nominal_m", rms_end(test.nominal)},
                      {"heading_rms_rad_per_m", rms_heading_per_metre(test.calibrated)},
                      {"heading_rms_nominal_rad_per_m", rms_heading_per_metre(test.nominal)}};
  for (std::size_t k = 0; k < test.names.size(); ++k) {
    out["each"].push_back({{"recording", test.names[k]},
                           {"driven_m", test.nominal[k].driven},
                           {"end_m", test.calibrated[k].end},
                           {"end_nominal_m", test.nominal[k].end},
                           {"heading_rad_per_m", test.calibrated[k].heading_per_metre()},
                           {"heading_nominal_rad_per_m", test.nominal[k].heading_per_metre()}});
  }
  return out;
}

ordered_json json(const CalibrationValidation& held) {
  const bool judged = held.legs() > 0;
  return {{"legs", held.legs()},
          {"held_out", held.scheme == HoldoutScheme::none     ? ordered_json()
                       : held.scheme == HoldoutScheme::blocks ? "blocks of legs"
                                                              : "recordings"},
          {"arrival_rms_m", judged ? ordered_json(held.calibrated.rms()) : ordered_json()},
          {"arrival_rms_nominal_m", judged ? ordered_json(held.nominal.rms()) : ordered_json()}};
}

ordered_json json(const WheelCalibration& found, const CalibrationValidation& held,
                  const std::optional<Tested>& test) {
  ordered_json out;
  const auto add = [&out](const char* name, const std::optional<Calibrated>& one) {
    out[name] = one ? ordered_json(one->value) : ordered_json();
    out[std::string("sd_") + name] = one ? ordered_json(one->sd) : ordered_json();
  };
  add("E_d", found.diameter_ratio);
  add("E_b", found.wheelbase_ratio);
  add("E_s", found.scale);
  add("k_left", found.noise_left);
  add("k_right", found.noise_right);
  if (!found.constants.empty()) {
    ordered_json constants;
    for (const DriveConstant& one : found.constants) {
      constants[std::string(name_of(one.channel))] = {{"g", one.g.value}, {"sd", one.g.sd}};
    }
    out["constants"] = constants;
  }
  out["chi2"] = found.chi2;
  out["dof"] = found.dof;
  out["heldout"] = json(held);
  if (test) out["test"] = json(*test);
  if (!found.truth.clocks.empty()) {
    ordered_json clocks = ordered_json::array();
    for (const auto& [session, clock] : found.truth.clocks) {
      clocks.push_back({{"session", session}, {"late_s", clock.late}, {"drift", clock.drift}});
    }
    out["truth"] = {{"ahead_m", found.truth.ahead},
                    {"left_m", found.truth.left},
                    {"heading_rad", found.truth.heading},
                    {"clocks", clocks}};
  }
  out["settled"] = found.settled;
  out["undetermined"] = found.undetermined;
  return out;
}

struct Verdict {
  Mood mood = Mood::doubt;
  std::string text;
};

/// What the held-out legs say of the calibration.
Verdict verdict(const CalibrationValidation& held) {
  const std::string errors = fmt::format(
      "{} {} end {:.1f} mm off (rms), nominal {:.1f} mm", held.legs(),
      held.scheme == HoldoutScheme::recordings ? "legs, each recording held out in turn,"
                                               : "held-out legs",
      1000.0 * held.calibrated.rms(), 1000.0 * held.nominal.rms());
  switch (held.gain()) {
    case CalibrationGain::unknown:
      return {Mood::doubt, "calibrated; no legs with truth could be held out to judge it by"};
    case CalibrationGain::uncertain:
      return {Mood::doubt,
              "calibrated: " + errors + "; too few legs, or too short, to tell which is better"};
    case CalibrationGain::better:
      return {Mood::good, "calibrated: " + errors};
    case CalibrationGain::worse:
      break;
  }
  return {Mood::bad, "calibration does not help: " + errors};
}

/// The same as a sentence.
std::string page_verdict(const CalibrationValidation& held) {
  std::string sentence = verdict(held).text + ".";
  sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string text(const Tested& test) {
  const auto line = [](const char* what, double before, double after, const char* unit) {
    return fmt::format("  {}  {:8.1f} -> {:.1f} {}\n", what, 1000.0 * before, 1000.0 * after, unit);
  };
  return fmt::format(
             "\n{} kept for the test, nominal -> calibrated (rms):\n",
             test.names.size() == 1 ? "1 drive" : fmt::format("{} drives", test.names.size())) +
         line("end point off by        ", rms_end(test.nominal), rms_end(test.calibrated), "mm") +
         line("heading off by, per metre", rms_heading_per_metre(test.nominal),
              rms_heading_per_metre(test.calibrated), "mrad/m");
}

/// "95 ms early", "20 ms early to 30 ms late" where sessions differ.
std::string lateness(double first, double last) {
  const auto words = [](double late) {
    return fmt::format("{:.0f} ms {}", 1000.0 * std::abs(late), late < 0.0 ? "early" : "late");
  };
  const std::string one = words(first);
  const std::string other = words(last);
  return one == other ? one : one + " to " + other;
}

std::string text(const TruthAlignment& truth) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const auto& [session, clock] : truth.clocks) {
    first = std::min(first, clock.late);
    last = std::max(last, clock.late);
  }
  return fmt::format(
      "  truth: the point tracked is {:.1f} mm ahead and {:.1f} mm left of the axle's centre, its\n"
      "  heading is off by {:.1f} mrad, its rows are {} at the start\n",
      1000.0 * truth.ahead, 1000.0 * truth.left, 1000.0 * truth.heading, lateness(first, last));
}

std::string text(const WheelCalibration& found, const CalibrationValidation& held,
                 const std::optional<Tested>& test) {
  const auto [mood, said] = verdict(held);
  std::string out = verdict_text(mood, said) + "\n";
  TextTable table;
  table.columns = {Align::left, Align::right, Align::left};
  const auto row = [&table](const char* name, const std::optional<Calibrated>& one,
                            const char* unit) {
    if (!one) return;
    const QuantityText cells = quantity_text(one->value, one->sd);
    table.rows.push_back({name, cells.value, "\u00b1 " + cells.error, unit});
  };
  table.columns.push_back(Align::left);
  row("E_d  right wheel / left wheel", found.diameter_ratio, "");
  row("E_b  wheelbase / nominal", found.wheelbase_ratio, "");
  row("E_s  true / measured travel", found.scale, "");
  row("k    left wheel's noise", found.noise_left, "m^1/2");
  row("k    right wheel's noise", found.noise_right, "m^1/2");
  for (const DriveConstant& one : found.constants) {
    const std::string name(facts_of(one.channel).does_what);
    const std::string unit(facts_of(one.channel).unit);
    const double size = unit.empty() ? 100.0 : 1.0;
    const QuantityText cells = quantity_text(size * one.g.value, size * one.g.sd);
    table.rows.push_back({name, cells.value, "\u00b1 " + cells.error, unit.empty() ? "%" : unit});
  }
  out += "\n" + table_text(table);
  const double dispersion = found.dof > 0 ? found.chi2 / found.dof : 0.0;
  out += fmt::format("\n  chi2/dof {:.3f} with {} degrees of freedom\n", dispersion, found.dof);
  if (dispersion > kFarTooLarge) {
    out += fmt::format(
        "  errors are {0:.1f} times what the model's noise allows: take the \u00b1 {0:.1f} times "
        "as "
        "large\n",
        std::sqrt(dispersion));
  }
  if (!found.truth.clocks.empty()) out += text(found.truth);
  if (test) out += text(*test);
  for (const std::string& one : found.undetermined) out += "\nnot determined: " + one + "\n";
  if (!found.settled) {
    out += "\n" + warning_text(
                      "the last round still moved an estimate by more than a tenth of its standard "
                      "error: wheels that differ in these figures alone do not explain the "
                      "recordings (trussmap diagnose looks for what does)");
  }
  return out;
}

void run_calibrate(const CalibrateOptions& options) {
  Progress progress({{"reading", 10}, {"calibrating", 45}, {"predicting held-out legs", 45}});
  progress.next();
  std::vector<Recording> recordings = read_recordings(options.recordings);
  std::vector<Recording> test_drives = read_recordings(options.test);
  const Model model = read_model(options.model, recordings);
  take_wheels(recordings, model.robot);
  take_wheels(test_drives, model.robot);
  warn_of_mistakes(recordings, model, options.model);
  WheelCalibration found;
  CalibrationValidation held;
  std::optional<Tested> test;
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
  Files files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(found.model));
  if (!options.json.empty()) {
    files.emplace_back(options.json, json(found, held, test).dump(2) + "\n");
  }
  if (options.page.wanted()) {
    add_page(files,
             with_drive(truth_page({found, held.nominal, held.calibrated, page_verdict(held)},
                                   subject_of(options.recordings, options.model)),
                        model.robot, recordings),
             options.page);
  }
  files.write();
  progress.end();
  fmt::print("{}", text(found, held, test));
}

}  // namespace

void setup_calibrate(const Command& app) {
  auto options = std::make_shared<CalibrateOptions>();
  const Command command = app.add_subcommand(
      "calibrate",
      "Calibrate wheels, wheelbase and wheel noise from recordings with truth or survey");
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
  command.add_option("--without", options->without, "Do not use the survey, or the truth")
      .delimiter(',')
      .check(one_of({"survey", "truth"}))
      .type_name("WHAT,...");
  add_html_option(command, options->page);
  add_plots_option(command, options->page);
  command.footer(
      "E_d, E_b and E_s become the model's effects wheel diameter ratio, wheelbase and wheel\n"
      "scale. Standard errors hold for the noise that the model states for truth, survey and\n"
      "sightings; chi2/dof should be near 1. Where truth tracks the robot, and how late, is found "
      "too.\n"
      "\n"
      "--test dead-reckons each recording from its first truth pose to its last, with the given\n"
      "model (nominal) and with the calibrated one: how far the end is off, and how far the "
      "change\n"
      "of heading, per metre of the wheels' mean travel (so that turns on the spot count).");
  command.callback([options] { run_calibrate(*options); });
}

}  // namespace trussmap::app
