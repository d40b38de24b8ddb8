// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Types of attributes that described results have, for the stubs (make_stubs.py writes them).
#pragma once

#include <functional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace trussmap::python {

/// `type` is asked for once all classes are there.
void note_attribute(const pybind11::handle& of, const std::string& name,
                    std::function<std::string()> type);

/// A line of its own in the stub of a class.
void note_method(const pybind11::handle& of, const std::string& line);

/// The attributes of a class that were noted, in their order.
[[nodiscard]] const std::vector<std::string>& noted_names(const pybind11::handle& of);

/// {class: lines of its stub} of all that were noted.
[[nodiscard]] pybind11::dict stub_lines();

}  // namespace trussmap::python
