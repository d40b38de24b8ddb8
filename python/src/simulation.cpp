// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// simulate.
#include "arrays.hpp"
#include "calls.hpp"
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/texts.hpp"

#include <map>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>
#include <variant>

namespace trussmap::python {
namespace {

struct SimulationResult {
  SimulatedRecording made;
  SimulationSettings settings;
  std::shared_ptr<Recording> recording;
  std::string folder;
};

using Member =
    std::variant<bool SimulationSettings::*, int SimulationSettings::*,
                 double SimulationSettings::*, std::string SimulationSettings::*,
                 std::uint64_t SimulationSettings::*, std::vector<double> SimulationSettings::*,
                 std::vector<std::string> SimulationSettings::*>;

const std::map<std::string, Member>& members() {
  using S = SimulationSettings;
  static const std::map<std::string, Member> kMembers{
      {"mesh", &S::mesh},
      {"spacing", &S::spacing},
      {"uneven", &S::uneven},
      {"walk", &S::walk},
      {"tours", &S::tours},
      {"seed", &S::seed},
      {"drive", &S::drive},
      {"wheelbase", &S::wheelbase},
      {"length", &S::length},
      {"wheel_left", &S::wheel_left},
      {"steer_left", &S::steer_left},
      {"steer_noise", &S::steer_noise},
      {"wheel_noise", &S::wheel_noise},
      {"compass_noise", &S::compass_noise},
      {"sighting_noise", &S::sighting_noise},
      {"survey_noise", &S::survey_noise},
      {"rough", &S::rough},
      {"noise_free", &S::noise_free},
      {"no_compass", &S::no_compass},
      {"gyro", &S::gyro},
      {"no_survey", &S::no_survey},
      {"range_sensor", &S::range_sensor},
      {"ranges_alone", &S::ranges_alone},
      {"bearings_alone", &S::bearings_alone},
      {"rests", &S::rests},
      {"gyro_noise", &S::gyro_noise},
      {"gyro_walk", &S::gyro_walk},
      {"reach", &S::reach},
      {"fix_rate", &S::fix_rate},
      {"fix_noise", &S::fix_noise},
      {"loop_noise", &S::loop_noise},
      {"loop_heading_noise", &S::loop_heading_noise},
      {"yaw_noise", &S::yaw_noise},
      {"full_turns", &S::full_turns},
      {"speeds", &S::speeds},
      {"turn_rates", &S::turn_rates},
      {"ramp", &S::ramp},
      {"overrun", &S::overrun},
      {"covariates", &S::covariates},
      {"true_rates", &S::true_rates},
      {"hide", &S::hide},
      {"loops", &S::loops},
      {"markers", &S::markers}};
  return kMembers;
}

template <typename T>
void set(SimulationSettings& settings, T SimulationSettings::*member, const std::string& name,
         py::handle value) {
  try {
    settings.*member = value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + ": " + std::string(py::repr(value)) +
                         " is of another type than simulate expects");
  }
}

SimulationSettings settings_of(const py::kwargs& given) {
  SimulationSettings settings;
  for (const auto& [key, value] : given) {
    const std::string name = key.cast<std::string>();
    const auto found = members().find(name);
    if (found == members().end()) {
      throw py::type_error("simulate() has no argument \"" + name + "\"");
    }
    const py::handle held = value;
    std::visit([&](auto member) { set(settings, member, name, held); }, found->second);
  }
  if (settings.speeds.size() != 2 || settings.turn_rates.size() != 2) {
    throw py::value_error("speeds, turn_rates: expected two, the slowest and the fastest");
  }
  return settings;
}

SimulationResult run_simulate(const py::object& effects, const py::object& folder,
                              const py::kwargs& settings) {
  SimulationResult result;
  result.settings = settings_of(settings);
  std::vector<Effect> acting;
  if (py::isinstance<Effect>(effects)) {
    acting.push_back(simulated_effect(effects.cast<Effect>()));
  } else {
    for (const py::handle one : py::iter(effects)) {
      acting.push_back(simulated_effect(one.cast<Effect>()));
    }
  }
  if (result.settings.hide && !acting.empty()) {
    throw py::value_error("hide: expected no effects beside it");
  }
  std::filesystem::path out;
  if (!folder.is_none()) out = folder.cast<std::filesystem::path>();
  result.folder = out.string();
  unlocked([&] {
    result.made = simulate(result.settings, acting);
    result.recording = std::make_shared<Recording>(result.made.drive.recording);
    result.recording->name = out.empty() ? "simulated" : out.string();
    if (!out.empty()) {
      write_recording(out, result.made.drive.recording, "",
                      {{"model.toml", format_model(result.made.model)}});
    }
  });
  return result;
}

py::dict true_path(const SimulationResult& self) {
  const std::vector<TrueRow>& rows = self.made.drive.motion.rows;
  py::dict columns;
  const auto add = [&](const char* name, const auto& get) {
    py::array_t<double> column(static_cast<py::ssize_t>(rows.size()));
    double* at = column.mutable_data();
    for (const TrueRow& row : rows) *at++ = get(row);
    columns[name] = read_only(column);
  };
  add("t", [](const TrueRow& row) { return row.t; });
  add("x", [](const TrueRow& row) { return row.pose.x; });
  add("y", [](const TrueRow& row) { return row.pose.y; });
  add("heading", [](const TrueRow& row) { return row.pose.heading; });
  return columns;
}

}  // namespace

void add_simulation(py::module_& module) {
  py::class_<SimulationResult>(module, "Simulation",
                               "The recording of a simulated robot, and what really was.")
      .def_property_readonly(
          "recording", [](const SimulationResult& self) { return self.recording; },
          "What the robot recorded.")
      .def_property_readonly(
          "model", [](const SimulationResult& self) { return self.made.model; },
          doc("SimulatedRecording.model"))
      .def_property_readonly(
          "effects",
          [](const SimulationResult& self) { return py::tuple(py::cast(self.made.effects)); },
          doc("SimulatedRecording.effects"))
      .def_property_readonly("true_path", true_path,
                             "Where the robot really was at the end of each row: t, x, y, heading.")
      .def_property_readonly(
          "length", [](const SimulationResult& self) { return self.made.length(); },
          doc("SimulatedRecording.length"))
      .def("__str__",
           [](const SimulationResult& self) {
             return for_print(simulation_text(self.made, self.settings, self.folder));
           })
      .def("__repr__", [](const SimulationResult& self) {
        return "<trussmap.Simulation of " + std::to_string(self.recording->drive.rows()) + " rows>";
      });
  module.def(
      "simulate", run_simulate, py::arg("effects") = py::tuple(), py::arg("folder") = py::none(),
      "The recording of a simulated robot on a mesh of landmarks, with effects (each with its "
      "coefficients) in its odometry; written to a folder, with model.toml, where one is given.\n\n"
      "Settings by name, those of `trussmap simulate` with _ for -: mesh=\"6x6\", spacing=5.0, "
      "uneven, walk=\"euler\", tours=3, seed=1, drive=\"differential\", wheelbase=0.34, length, "
      "wheel_noise=0.003, compass_noise=0.02, no_compass, gyro, range_sensor, ranges_alone, "
      "bearings_alone, fix_rate, loops, markers, no_survey, noise_free, rough, hide, ...");
}

}  // namespace trussmap::python
