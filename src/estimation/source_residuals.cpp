// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/source_residuals.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {

const char* noise_source(MeasurementKind kind, Eigen::Index row) {
  switch (kind) {
    case MeasurementKind::segment:
      return row == 3 ? "compass" : "wheels";
    case MeasurementKind::standing:
      return "sighting";
    case MeasurementKind::view:
      return row == 0 ? "range" : "bearing";
    case MeasurementKind::cartesian_view:
      return "range";
    case MeasurementKind::survey:
      return "survey";
    case MeasurementKind::truth:
      return row == 2 ? "truth_heading" : "truth";
  }
  return "";
}

std::vector<SourceResiduals> residuals_by_source(const RecordingProblem& problem,
                                                 const std::vector<CheckedMeasurement>& checked) {
  std::vector<SourceResiduals> result;
  for (const CheckedMeasurement& one : checked) {
    const Measurement& measured = problem.measurements[idx(one.measurement)];
    for (Eigen::Index row = 0; row < measured.rows; ++row) {
      if (!std::isfinite(one.minimal_detectable[row])) continue;
      const char* source = noise_source(measured.kind, row);
      auto at = std::find_if(result.begin(), result.end(), [source](const SourceResiduals& other) {
        return other.source == source;
      });
      if (at == result.end()) at = result.insert(result.end(), {source, {}});
      at->standardised.push_back(one.standardised[row]);
    }
  }
  for (SourceResiduals& one : result) {
    std::sort(one.standardised.begin(), one.standardised.end());
  }
  return result;
}

}  // namespace trussmap
