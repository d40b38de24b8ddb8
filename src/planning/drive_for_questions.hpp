// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From questions to the drive that answers them.
#pragma once

#include "planning/tour_search.hpp"
#include "trussmap/session.hpp"

#include <vector>

namespace trussmap::planning {

/// The questions of which even a thorough tour tells less than a quarter of what is lacking.
/// `before`: lambda of each without a drive.
[[nodiscard]] std::vector<bool> beyond_drives(const SearchTask& task,
                                              const std::vector<double>& before);

/// Plans for the questions that are not `beyond`: the result gets the drive, where there is one,
/// and what instruments are worth on it. Lambdas of all questions with it, else without.
[[nodiscard]] std::vector<double> drive_for(const SearchTask& task, const std::vector<bool>& beyond,
                                            PlannedDrive& result);

}  // namespace trussmap::planning
