// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap calibrate: wheels, wheelbase and wheel noise from recordings with truth or survey.
#include "trussmap/adjustment/truth_holdout.hpp"
#include "trussmap/adjustment/wheel_calibration.hpp"
#include "trussmap/core/error.hpp"
#include "trussmap/io/atomic_file.hpp"
#include "trussmap/io/model_toml.hpp"
#include "trussmap/io/recording_csv.hpp"
#include "trussmap/report/table.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "option_checks.hpp"

namespace trussmap::app {
namespace {

using nlohmann::ordered_json;

struct CalibrateOptions {
  std::vector<std::string> recordings;
  std::string model;
  std::string out;
  std::string json;
  double holdout = 0.3;
  double leg = 1.0;  // m
  std::vector<std::string> without;
};

struct HeldOut {
  int legs = 0;
  double nominal = 0.0;     // m
  double calibrated = 0.0;  // m
};

WheelCalibrationOptions calibration_options(const CalibrateOptions& options) {
  const auto left_out = [&options](const char* what) {
    return std::find(options.without.begin(), options.without.end(), what) != options.without.end();
  };
  WheelCalibrationOptions result;
  result.problem.survey = !left_out("survey");
  result.problem.truth = !left_out("truth");
  return result;
}

/// How well a calibration by the other legs predicts the held-out ones. None without truth.
HeldOut held_out(const std::vector<Recording>& recordings, const Model& model,
                 const CalibrateOptions& options) {
  HeldOut result;
  WheelCalibrationOptions how = calibration_options(options);
  if (!how.problem.truth || !(options.holdout > 0.0)) return result;
  const std::vector<TruthLeg> legs = truth_legs(recordings, options.holdout, options.leg);
  const ArrivalErrors nominal = arrival_errors(recordings, legs, model);
  if (nominal.legs == 0) return result;
  how.noise = false;
  try {
    const WheelCalibration other = calibrate_wheels(without_held_out(recordings, legs), model, how);
    result.calibrated = arrival_errors(recordings, legs, other.model).rms;
  } catch (const SolveError&) {  // too few legs are left to calibrate by
    return result;
  } catch (const InputError&) {
    return result;
  }
  result.legs = nominal.legs;
  result.nominal = nominal.rms;
  return result;
}

ordered_json json(const WheelCalibration& found, const HeldOut& held) {
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
  out["chi2"] = found.chi2;
  out["dof"] = found.dof;
  const bool judged = held.legs > 0;
  out["heldout"] = {
      {"legs", held.legs},
      {"arrival_rms_m", judged ? ordered_json(held.calibrated) : ordered_json()},
      {"arrival_rms_nominal_m", judged ? ordered_json(held.nominal) : ordered_json()}};
  out["undetermined"] = found.undetermined;
  return out;
}

std::string text(const WheelCalibration& found, const HeldOut& held) {
  std::string out =
      held.legs == 0 ? std::string("calibrated; no legs with truth are held out to judge it by\n")
      : held.calibrated < held.nominal
          ? fmt::format("calibrated: held-out legs end {:.1f} mm off (rms), nominal {:.1f} mm\n",
                        1000.0 * held.calibrated, 1000.0 * held.nominal)
          : fmt::format(
                "calibration does not help: held-out legs end {:.1f} mm off (rms), nominal "
                "{:.1f} mm\n",
                1000.0 * held.calibrated, 1000.0 * held.nominal);
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
  out += "\n" + format_table(table);
  out += fmt::format("\n  chi2/dof {:.3f} with {} degrees of freedom\n",
                     found.dof > 0 ? found.chi2 / found.dof : 0.0, found.dof);
  for (const std::string& one : found.undetermined) out += "\nnot determined: " + one + "\n";
  return out;
}

void run_calibrate(const CalibrateOptions& options) {
  std::vector<Recording> recordings;
  for (const std::string& folder : options.recordings) {
    recordings.push_back(read_recording(folder));
  }
  const Model model = read_model(options.model);
  WheelCalibration found;
  HeldOut held;
  try {
    found = calibrate_wheels(recordings, model, calibration_options(options));
    held = held_out(recordings, model, options);
  } catch (const std::invalid_argument& error) {
    throw InputError(options.model, 0, error.what());
  }
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  if (!options.out.empty()) files.emplace_back(options.out, format_model(found.model));
  if (!options.json.empty()) {
    files.emplace_back(options.json, json(found, held).dump(2) + "\n");
  }
  write_files(files);
  fmt::print("{}", text(found, held));
}

}  // namespace

void setup_calibrate(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Calibrate wheels, wheelbase and wheel noise from recordings with truth or survey");
  command->add_option("RECORDING", options->recordings, "Folders of CSV streams")->required();
  command->add_option("--model", options->model, "Model to start from (TOML)")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", options->out, "Write the model with what was found (TOML)")
      ->type_name("FILE");
  command->add_option("--json", options->json, "Write every figure as JSON")->type_name("FILE");
  command
      ->add_option("--holdout", options->holdout,
                   "Share of the legs with truth that are kept aside to judge the calibration")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_option("--leg", options->leg, "Length of such a leg [m of driven path]")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--without", options->without, "Do not use the survey, or the truth")
      ->delimiter(',')
      ->check(CLI::IsMember({"survey", "truth"}))
      ->type_name("WHAT,...");
  command->footer(
      "E_d, E_b and E_s become the model's effects wheel diameter ratio, wheelbase and wheel\n"
      "scale. Standard errors hold for the noise that the model states for truth, survey and\n"
      "sightings; chi2/dof should be near 1.");
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace trussmap::app
