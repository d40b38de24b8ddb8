// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Standardised residuals of data_snooping.hpp, source by source: is each as noisy as stated, and
// normal?
#pragma once

#include "estimation/data_snooping.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// The source of noise of one row of a measurement.
[[nodiscard]] const char* noise_source(MeasurementKind kind, Eigen::Index row);

/// Standardised residuals of one source of noise ("wheels", "compass", "sighting", "range",
/// "bearing", "survey", "truth", "truth_heading"): a sample of the standard normal distribution
/// where the source is as noisy as stated.
struct SourceResiduals {
  std::string source;
  std::vector<double> standardised;  ///< ascending; what is not checked is not among them
};

/// Sources in the order in which they first appear.
[[nodiscard]] std::vector<SourceResiduals> residuals_by_source(
    const RecordingProblem& problem, const std::vector<CheckedMeasurement>& checked);

}  // namespace trussmap
