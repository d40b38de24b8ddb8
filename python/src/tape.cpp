// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// umbmark and wheel_noise: calibrations with a tape measure.
#include "arrays.hpp"
#include "calls.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "results.hpp"
#include "rows.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/texts.hpp"

#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

bool is_path(py::handle value) {
  return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
}

/// Of a wheelbase [m], a Model or a model's file.
Model starting_model(py::handle robot) {
  if (py::isinstance<Model>(robot)) return robot.cast<Model>();
  if (is_path(robot)) return read_model(robot.cast<fs::path>());
  Model model;
  model.robot.wheelbase = robot.cast<double>();
  if (!(model.robot.wheelbase > 0.0)) throw py::value_error("wheelbase: expected more than 0 m");
  return model;
}

std::vector<Eigen::Vector2d> ends_of(py::handle values, const char* name) {
  std::vector<Eigen::Vector2d> ends;
  for (const std::vector<double>& row : number_rows(values, 2, name)) {
    ends.emplace_back(row[0], row[1]);
  }
  return ends;
}

/// A file, or a pair of arrays.
SquareRuns runs_of(py::handle value, double side) {
  if (is_path(value))
    return read_square_runs(value.cast<fs::path>(), path_length(square_path(side, {})));
  const py::sequence pair = py::reinterpret_borrow<py::sequence>(value);
  if (!py::isinstance<py::sequence>(value) || py::len(pair) != 2) {
    throw py::type_error("runs: expected a file, or (cw, ccw): end errors of runs, n x 2 each");
  }
  return {ends_of(pair[0], "cw"), ends_of(pair[1], "ccw")};
}

struct SquareResult {
  std::vector<SquareRound> rounds;
  SquareMethod method = SquareMethod::exact;
  Model given;
  Model model;
  double side = 4.0;

  [[nodiscard]] const SquareSolution& solution() const {
    return method == SquareMethod::exact ? rounds.back().exact : rounds.back().formulas;
  }
  [[nodiscard]] SquareCorrections corrections() const {
    return corrections_after(rounds.back(), method);
  }
};

SquareResult run_umbmark(const py::args& runs, const py::object& wheelbase, double side,
                         const std::string& solution) {
  if (runs.empty()) throw py::value_error("runs: expected those of one round at least");
  if (!(side > 0.0)) throw py::value_error("side: expected more than 0 metres");
  if (solution != "exact" && solution != "formulas") {
    throw py::value_error("solution: \"" + solution + "\": expected exact or formulas");
  }
  SquareResult result;
  result.method = solution == "exact" ? SquareMethod::exact : SquareMethod::formulas;
  result.model = starting_model(wheelbase);
  result.side = side;
  std::vector<SquareRuns> all;
  for (const py::handle one : runs) all.push_back(runs_of(one, side));
  result.rounds = square_rounds(
      all.size(), side, result.model.robot.wheelbase, geometry_errors(result.model), result.method,
      [&all](std::size_t round, const SquareSetup&, const GeometryErrors&) { return all[round]; });
  result.given = result.model;
  result.model = with_geometry(result.given, result.corrections().errors);
  return result;
}

py::list table(const SquareResult& self) {
  py::list rows;
  const auto add = [&rows](const char* name, const Estimate& one, const char* unit) {
    py::dict row;
    row["constant"] = name;
    row["value"] = one.value;
    row["sd"] = one.standard_error;
    row["unit"] = unit;
    rows.append(row);
  };
  add("E_d", self.solution().diameter_ratio, "");
  add("E_b", self.solution().wheelbase_ratio, "");
  add("alpha", self.solution().alpha, "rad");
  add("beta", self.solution().beta, "rad");
  add("wheelbase", self.corrections().wheelbase, "m");
  add("c_left", self.corrections().left_factor, "");
  add("c_right", self.corrections().right_factor, "");
  return rows;
}

RobotConstants squares_constants(const SquareResult& self) {
  return robot_constants(self.given, self.rounds, self.method);
}

std::string squares_text(const SquareResult& self) {
  return square_text(self.rounds, self.method) + constants_text(squares_constants(self));
}

Page squares_page(const SquareResult& self) {
  const SquareCorrections use = self.corrections();
  return with_constants(square_page({self.rounds, self.side, use.wheelbase, use.left_factor,
                                     use.right_factor, all_doubts(self.rounds)},
                                    "squares"),
                        squares_constants(self));
}

py::tuple pair(const Estimate& one) {
  return py::make_tuple(one.value, one.standard_error);
}

void add_squares_class(py::module_& module) {
  py::class_<SquareResult> type(module, "Umbmark",
                                "Wheel diameters and wheelbase from squares; constants with their "
                                "standard errors, corrections of all rounds together.");
  show(type, squares_text, squares_page);
  show_constants(type, squares_constants);
  type.def_property_readonly(
          "E_d", [](const SquareResult& self) { return pair(self.solution().diameter_ratio); },
          "Right over left wheel diameter, of the last round.")
      .def_property_readonly(
          "E_b", [](const SquareResult& self) { return pair(self.solution().wheelbase_ratio); },
          "Actual over nominal wheelbase, of the last round.")
      .def_property_readonly(
          "wheelbase", [](const SquareResult& self) { return pair(self.corrections().wheelbase); },
          "m, to use from now on.")
      .def_property_readonly(
          "c_left", [](const SquareResult& self) { return pair(self.corrections().left_factor); },
          doc("SquareCorrections.left_factor"))
      .def_property_readonly(
          "c_right", [](const SquareResult& self) { return pair(self.corrections().right_factor); },
          doc("SquareCorrections.right_factor"))
      .def_property_readonly(
          "largest_offset",
          [](const SquareResult& self) { return pair(self.rounds.back().clusters.largest_offset); },
          doc("SquareClusters.largest_offset"))
      .def_property_readonly(
          "second_round_worthwhile",
          [](const SquareResult& self) {
            return self.rounds.back().clusters.second_round_worthwhile;
          },
          doc("SquareClusters.second_round_worthwhile"))
      .def_readonly("model", &SquareResult::model, "With what was found in it.")
      .def_property_readonly(
          "doubts", [](const SquareResult& self) { return all_doubts(self.rounds); }, "In words.")
      .def("table", table, "A list of dicts: constant, value, sd, unit.")
      .def("__repr__", [](const SquareResult& self) {
        return "<trussmap.Umbmark of " + std::to_string(self.rounds.size()) + " rounds>";
      });
  module.def("umbmark", run_umbmark, py::arg("wheelbase"), py::arg("side") = SquareSetup().side,
             py::arg("solution") = "exact",
             "Wheel diameters and wheelbase from a square driven both ways (Borenstein & Feng "
             "1996).\n\n"
             "`runs`, a round each: a file (direction,x,y), or (cw, ccw), the end errors of the "
             "runs, absolute - calculated, in m and in the frame of the start, n x 2. `wheelbase` "
             "[m] that the robot calculated with, or a Model. `solution`: exact or formulas.");
}

struct WheelNoiseResult {
  NoiseAnalysis found;
  Model model;
};

WheelNoiseResult run_wheel_noise(const py::object& errors, const py::object& wheelbase,
                                 const std::string& path, const py::object& sensor_sd,
                                 bool subtract_mean) {
  WheelNoiseResult result;
  result.model = starting_model(wheelbase);
  NoiseExperiment experiment;
  experiment.path = parse_path(path);
  experiment.wheelbase =
      result.model.robot.wheelbase * geometry_errors(result.model).wheelbase_ratio;
  experiment.sensor_sd = matrix<Eigen::Vector3d>(sensor_sd, "sensor_sd");
  experiment.subtract_mean = subtract_mean;
  EndErrors ends;
  if (is_path(errors)) {
    ends = read_end_errors(errors.cast<fs::path>(),
                           largest_end_error(experiment.path, experiment.wheelbase));
  } else {
    for (const std::vector<double>& row : number_rows(errors, 3, "errors")) {
      ends.emplace_back(row[0], row[1], row[2]);
    }
  }
  unlocked([&] { result.found = analyse_wheel_noise(std::move(ends), experiment); });
  result.model.noise.left = result.found.estimate.left.k;
  result.model.noise.right = result.found.estimate.right.k;
  return result;
}

py::list noise_table(const WheelNoiseResult& self) {
  py::list rows;
  const auto add = [&rows](const char* wheel, const WheelConstant& one) {
    py::dict row;
    row["wheel"] = wheel;
    row["k"] = one.k;
    row["sd"] = one.standard_error;
    row["upper_limit"] = one.upper_limit;
    rows.append(row);
  };
  add("left", self.found.estimate.left);
  add("right", self.found.estimate.right);
  return rows;
}

std::string runs_text(const WheelNoiseResult& self) {
  return wheel_noise_text(self.found);
}

Page runs_page(const WheelNoiseResult& self) {
  return noise_page({self.found.errors, self.found.estimate, self.found.fit,
                     path_length(self.found.experiment.path), self.found.doubts},
                    "runs");
}

void add_noise_class(py::module_& module) {
  RowClass<WheelConstant>(module, "WheelConstant")
      .field("k", &WheelConstant::k)
      .field("standard_error", &WheelConstant::standard_error)
      .field("upper_limit", &WheelConstant::upper_limit);
  py::class_<WheelNoiseResult> type(module, "WheelNoise", "How noisy each wheel is.");
  show(type, runs_text, runs_page);
  type.def_property_readonly(
          "left", [](const WheelNoiseResult& self) { return self.found.estimate.left; },
          "Of the left wheel.")
      .def_property_readonly(
          "right", [](const WheelNoiseResult& self) { return self.found.estimate.right; },
          "Of the right wheel.")
      .def_property_readonly(
          "runs", [](const WheelNoiseResult& self) { return self.found.estimate.runs; },
          "How many.")
      .def_property_readonly(
          "mean", [](const WheelNoiseResult& self) { return array_of(self.found.estimate.mean); },
          "Of the end errors: m, m, rad.")
      .def_property_readonly(
          "observed",
          [](const WheelNoiseResult& self) { return array_of(self.found.estimate.observed); },
          "Covariance of the end errors, 3 x 3.")
      .def_property_readonly(
          "modelled",
          [](const WheelNoiseResult& self) { return array_of(self.found.estimate.modelled); },
          "The same as the estimate has it.")
      .def_property_readonly(
          "good", [](const WheelNoiseResult& self) { return self.found.fit.good; },
          doc("NoiseFit.good"))
      .def_readonly("model", &WheelNoiseResult::model, "With what was found in it.")
      .def_property_readonly(
          "doubts", [](const WheelNoiseResult& self) { return self.found.doubts; }, "In words.")
      .def("table", noise_table, "A list of dicts: wheel, k, sd, upper_limit [m^(1/2)].")
      .def("__repr__", [](const WheelNoiseResult& self) {
        return "<trussmap.WheelNoise of " + std::to_string(self.found.estimate.runs) + " runs>";
      });
  module.def("wheel_noise", run_wheel_noise, py::arg("errors"), py::kw_only(), py::arg("wheelbase"),
             py::arg("path") = "10,-10", py::arg("sensor_sd") = py::make_tuple(0.0, 0.0, 0.0),
             py::arg("subtract_mean") = false,
             "How noisy each wheel is, from one path driven many times (Chong & Kleeman 1997).\n\n"
             "`errors`: end errors of the runs, absolute - calculated, x, y [m], heading [rad] in "
             "the frame of the start, n x 3, or a file with these columns. `path`: segments in the "
             "order driven: 10 a straight drive of 10 m, -10 one backwards, a90 a turn on the spot "
             "by 90 degrees, 3@45 an arc of 3 m that turns by 45 degrees. `sensor_sd`: of the "
             "measured ends, m, m, rad. `wheelbase` [m], or a Model.");
}

}  // namespace

void add_squares(py::module_& module) {
  add_squares_class(module);
}

void add_wheel_noise(py::module_& module) {
  add_noise_class(module);
}

}  // namespace trussmap::python
