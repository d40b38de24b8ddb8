// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A recording from tables of columns, which are copied once.
#pragma once

#include "trussmap/recording.hpp"

#include <memory>
#include <pybind11/pybind11.h>
#include <string>

namespace trussmap::python {

/// Each a dict of arrays, a data frame or an array of records; all but `drive` may be None.
/// TypeError, ValueError with table and column on what they should not be.
[[nodiscard]] std::shared_ptr<Recording> recording_of(
    const pybind11::object& drive, const pybind11::object& sightings, const pybind11::object& fixes,
    const pybind11::object& loops, const pybind11::object& survey, const pybind11::object& truth,
    const std::string& name);

}  // namespace trussmap::python
