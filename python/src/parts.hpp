// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What each part of the package registers in its module.
#pragma once

#include <pybind11/pybind11.h>

namespace trussmap::python {

void add_errors(pybind11::module_& module);
void add_models(pybind11::module_& module);
void add_recordings(pybind11::module_& module);
void add_bags(pybind11::module_& module);
void add_responses(pybind11::module_& module);
void add_fits(pybind11::module_& module);
void add_comparison(pybind11::module_& module);
void add_diagnosis(pybind11::module_& module);
void add_discovery(pybind11::module_& module);
void add_map(pybind11::module_& module);
void add_poses(pybind11::module_& module);
void add_fleets(pybind11::module_& module);
void add_check(pybind11::module_& module);
void add_simulation(pybind11::module_& module);
void add_calibration(pybind11::module_& module);
void add_squares(pybind11::module_& module);
void add_wheel_noise(pybind11::module_& module);
void add_pose_graph(pybind11::module_& module);
void add_map_builder(pybind11::module_& module);
void add_corrected_odometry(pybind11::module_& module);

}  // namespace trussmap::python
