// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The module trussmap._core; trussmap/__init__.py gives its names out.
#include "parts.hpp"
#include "stubs.hpp"
#include "trussmap/running.hpp"

#include <string>

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of trussmap.";
  module.attr("__version__") = TRUSSMAP_VERSION;
  trussmap::python::add_errors(module);
  trussmap::python::add_models(module);
  trussmap::python::add_recordings(module);
  trussmap::python::add_bags(module);
  trussmap::python::add_responses(module);
  trussmap::python::add_fits(module);
  trussmap::python::add_comparison(module);
  trussmap::python::add_diagnosis(module);
  trussmap::python::add_discovery(module);
  trussmap::python::add_map(module);
  trussmap::python::add_poses(module);
  trussmap::python::add_fleets(module);
  trussmap::python::add_check(module);
  trussmap::python::add_simulation(module);
  trussmap::python::add_calibration(module);
  trussmap::python::add_squares(module);
  trussmap::python::add_wheel_noise(module);
  trussmap::python::add_pose_graph(module);
  trussmap::python::add_map_builder(module);
  trussmap::python::add_corrected_odometry(module);
  module.def("_stub_lines", &trussmap::python::stub_lines,
             "What make_stubs.py writes of classes whose attributes are lists of fields.");
  module.def("set_threads", &trussmap::set_threads, py::arg("threads"),
             "For calls from now on; the figures are the same, whatever their number.");
  module.def("threads", &trussmap::threads, "On how many threads calls work; 1 until it is set.");
}
