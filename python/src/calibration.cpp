// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// calibrate: wheels, wheelbase and wheel noise from recordings with truth or survey.
#include "calls.hpp"
#include "parts.hpp"
#include "results.hpp"
#include "rows.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/check.hpp"
#include "trussmap/texts.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct CalibrationResult {
  Model given;
  WheelCalibration found;
  CalibrationValidation held;
  std::optional<TestedDrives> test;
  std::shared_ptr<const std::vector<DrivenRecording>> recordings;
  Robot robot;
  std::string subject;
  std::vector<std::string> mistakes;
};

CalibrationOptions options_of(const std::vector<std::string>& without, double holdout, double leg) {
  if (!(holdout >= 0.0 && holdout <= 0.9)) {
    throw py::value_error("holdout: expected a share from 0 to 0.9");
  }
  if (!(leg > 0.0)) throw py::value_error("leg: expected more than 0 metres");
  CalibrationOptions options;
  options.holdout = holdout;
  options.leg = leg;
  for (const std::string& one : without) {
    if (one != "survey" && one != "truth" && one != "fixes") {
      throw py::value_error("without: \"" + one + "\" is none of survey, truth and fixes");
    }
    (one == "survey" ? options.survey : one == "truth" ? options.truth : options.fixes) = false;
  }
  return options;
}

CalibrationResult run_calibrate(const py::object& recordings, const py::object& model,
                                const py::object& test, const std::vector<std::string>& without,
                                double holdout, double leg, double gate,
                                const py::object& progress) {
  const Given given = python::given(recordings, model);
  CalibrationOptions how = options_of(without, holdout, leg);
  how.gate = gate;
  std::optional<Given> kept;
  if (!test.is_none() && !(py::isinstance<py::sequence>(test) && py::len(test) == 0)) {
    kept = python::given(test, model);
  }
  CallProgress told(progress,
                    {{"reading", 10}, {"calibrating", 45}, {"predicting held-out legs", 45}});
  CalibrationResult result;
  result.subject = subject_of(given);
  unlocked([&] {
    told.next();
    Read input = read(given);
    for (const CheckFinding& one :
         check_read_recordings(input.recordings, &input.model, input.model_name)) {
      result.mistakes.push_back(in_words(one));
    }
    result.robot = input.model.robot;
    result.given = input.model;
    result.recordings = std::make_shared<const std::vector<DrivenRecording>>(
        with_wheels(std::move(input.recordings), input.model.robot));
    const std::vector<DrivenRecording>& used = *result.recordings;
    told.next();
    result.found = calibrate_wheels(used, input.model, how);
    told.next();
    result.held = validate_calibration(used, input.model, how);
    if (!kept) return;
    const std::vector<DrivenRecording> drives =
        with_wheels(read(*kept).recordings, input.model.robot);
    TestedDrives tested;
    for (const DrivenRecording& one : drives) tested.names.push_back(one.name);
    tested.nominal = drive_errors(drives, input.model);
    tested.calibrated = drive_errors(drives, result.found.model, result.found.truth);
    result.test = std::move(tested);
  });
  warn(result.mistakes);
  told.end();
  return result;
}

/// (value, standard error), or None.
py::object pair(const std::optional<Calibrated>& one) {
  if (!one) return py::none();
  return py::make_tuple(one->value, one->sd);
}

py::list table(const CalibrationResult& self) {
  py::list rows;
  const auto add = [&rows](const std::string& name, const std::optional<Calibrated>& one,
                           const std::string& unit) {
    if (!one) return;
    py::dict row;
    row["constant"] = name;
    row["value"] = one->value;
    row["sd"] = one->sd;
    row["unit"] = unit;
    rows.append(row);
  };
  add("E_d", self.found.diameter_ratio, "");
  add("E_b", self.found.wheelbase_ratio, "");
  add("E_s", self.found.scale, "");
  add("k_left", self.found.noise_left, "m^1/2");
  add("k_right", self.found.noise_right, "m^1/2");
  for (const DriveConstant& one : self.found.constants) {
    add(std::string(name_of(one.channel)), one.g, std::string(facts_of(one.channel).unit));
  }
  return rows;
}

RobotConstants constants(const CalibrationResult& self) {
  return with_velocity_variances(robot_constants(self.given, self.found), *self.recordings,
                                 self.found.model);
}

std::string text(const CalibrationResult& self) {
  return calibration_text(self.found, self.held, self.test) + constants_text(constants(self));
}

Page page(const CalibrationResult& self) {
  const Page page = truth_page({self.found, self.held.nominal, self.held.calibrated,
                                calibration_verdict(self.found, self.held)},
                               self.subject);
  return with_drive(with_constants(page, constants(self)), self.robot, *self.recordings);
}

}  // namespace

void add_calibration(py::module_& module) {
  py::class_<CalibrationResult> type(
      module, "Calibration",
      "Wheels, wheelbase and wheel noise; each constant with its "
      "standard error, None where the motion does not determine it.");
  show(type, text, page);
  show_constants(type, constants);
  type.def_property_readonly(
          "model",
          [](const CalibrationResult& self) { return with_wheelbase_in_robot(self.found.model); },
          "The given one with all of that in it, the wheelbase in its robot.")
      .def_property_readonly(
          "E_d", [](const CalibrationResult& self) { return pair(self.found.diameter_ratio); },
          "Right over left wheel diameter.")
      .def_property_readonly(
          "E_b", [](const CalibrationResult& self) { return pair(self.found.wheelbase_ratio); },
          "Actual over nominal wheelbase.")
      .def_property_readonly(
          "E_s", [](const CalibrationResult& self) { return pair(self.found.scale); },
          "True over measured travel.")
      .def_property_readonly(
          "k_left", [](const CalibrationResult& self) { return pair(self.found.noise_left); },
          "Noise of the left wheel, m^(1/2).")
      .def_property_readonly(
          "k_right", [](const CalibrationResult& self) { return pair(self.found.noise_right); },
          "Noise of the right wheel, m^(1/2).")
      .def_property_readonly(
          "constants",
          [](const CalibrationResult& self) {
            py::dict constants;
            for (const DriveConstant& one : self.found.constants) {
              constants[py::str(std::string(name_of(one.channel)))] = pair(one.g);
            }
            return constants;
          },
          doc("WheelCalibration.constants"))
      .def_property_readonly(
          "chi2", [](const CalibrationResult& self) { return self.found.chi2; }, "Of the fit.")
      .def_property_readonly(
          "dof", [](const CalibrationResult& self) { return self.found.dof; }, "Of the fit.")
      .def_property_readonly(
          "settled", [](const CalibrationResult& self) { return self.found.settled; },
          doc("WheelCalibration.settled"))
      .def_property_readonly(
          "undetermined", [](const CalibrationResult& self) { return self.found.undetermined; },
          doc("WheelCalibration.undetermined"))
      .def_property_readonly(
          "left_out", [](const CalibrationResult& self) { return self.found.left_out; },
          doc("WheelCalibration.left_out"))
      .def_property_readonly(
          "arrival_rms", [](const CalibrationResult& self) { return self.held.calibrated.rms(); },
          "m, of held-out legs; 0 without legs.")
      .def_property_readonly(
          "arrival_rms_nominal",
          [](const CalibrationResult& self) { return self.held.nominal.rms(); },
          "m, of the same legs by the model given.")
      .def("table", table, "A list of dicts: constant, value, sd, unit.")
      .def("__repr__", [](const CalibrationResult& self) {
        return "<trussmap.Calibration: " + calibration_verdict(self.found, self.held) + ">";
      });
  module.def("calibrate", run_calibrate, py::arg("recordings"), py::arg("model"), py::kw_only(),
             py::arg("test") = py::tuple(), py::arg("without") = std::vector<std::string>(),
             py::arg("holdout") = CalibrationOptions().holdout,
             py::arg("leg") = CalibrationOptions().leg, py::arg("gate") = CalibrationOptions().gate,
             py::arg("progress") = py::none(),
             doc("Wheels, wheelbase and wheel noise from recordings with truth or survey; `test`: "
                 "recordings to test the calibration on.",
                 "calibrate_wheels")
                 .c_str());
}

}  // namespace trussmap::python
