// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which rows of a recording its adjustment takes, and the instants at which it asks for a pose.
#pragma once

#include "estimation/recording_problem.hpp"

#include <vector>

namespace trussmap::estimation {

/// Rows of truth and fixes; of sightings and loops all.
struct RowsUsed {
  std::vector<std::size_t> truth;
  std::vector<std::size_t> fixes;
  bool loops = false;
};

/// Throws InputError where a recording has nothing in use that ties it to a place.
[[nodiscard]] RowsUsed rows_used(const DrivenRecording& recording, const ProblemOptions& options);

/// When something is measured, at both ends of loops, and at changes between spinning and driving,
/// s, ascending; without instants inside what is left out, and those that would stand alone.
[[nodiscard]] std::vector<double> session_instants(const DrivenRecording& recording,
                                                   const RowsUsed& used, const Robot& robot,
                                                   const ProblemOptions& options,
                                                   const std::vector<TimeSpan>& left_out);

}  // namespace trussmap::estimation
