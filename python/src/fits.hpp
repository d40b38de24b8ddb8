// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What results of fits have in common.
#pragma once

#include "trussmap/noise_fit.hpp"

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace trussmap::python {

/// Budgets as rows of horizon, rms and the shares.
[[nodiscard]] pybind11::list budget_rows(const std::vector<NoiseBudget>& budget);
/// What was found of each source, a dict each.
[[nodiscard]] pybind11::list noise_rows(const FittedNoise& noise);

/// The one of these names; ValueError, listing them, on another.
[[noreturn]] void no_table(const std::string& what, const std::vector<std::string>& tables);

}  // namespace trussmap::python
