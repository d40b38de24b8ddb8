// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Calibration of the wheels (trussmap/calibrate.hpp) from parts of recordings.
#pragma once

#include "estimation/measurement_kind.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/calibrate.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::calibration {

/// chi^2/dof.
[[nodiscard]] inline double scatter_of(const WheelCalibration& found) {
  return found.chi2 / std::max(1, found.dof);
}

struct WheelCalibrationOptions {
  estimation::ProblemOptions problem;
  bool noise = true;  ///< estimate k_L and k_R too
  /// Of each recording, where several are segments of one drive; empty: each is its own.
  std::vector<int> sessions;
  std::vector<Channel> seldom = {};  ///< of seldom_constants those that are sought
  /// Squared standard deviations beyond which a sighting, fix or loop that the others contradict is
  /// left out of a fit, as long as these are few (gate.hpp); none: all stay.
  std::optional<double> gate = std::nullopt;
  int rounds = 8;  ///< of least squares, at most
};

[[nodiscard]] WheelCalibrationOptions calibration_options(const CalibrationOptions& options);

[[nodiscard]] WheelCalibration calibrate_wheels(const std::vector<DrivenRecording>& recordings,
                                                const Model& model,
                                                const WheelCalibrationOptions& options);

/// A row of a recording's stream.
struct LeftOutRow {
  estimation::RecordingStream stream = estimation::RecordingStream::sightings;
  int session = 0;
  std::size_t row = 0;
  std::string text;  ///< what it says
};

/// A calibration, and what its gate left out.
struct CalibrationByParts {
  WheelCalibration found;
  std::vector<LeftOutRow> left_out;
};
[[nodiscard]] CalibrationByParts calibrated_by_parts(std::vector<double> g,
                                                     const std::vector<DrivenRecording>& recordings,
                                                     const Model& model,
                                                     const WheelCalibrationOptions& options);

/// From these values of the constants (sought_constants.hpp) on, by least squares.
[[nodiscard]] WheelCalibration calibrated_from(std::vector<double> g,
                                               const std::vector<DrivenRecording>& recordings,
                                               const Model& model,
                                               const WheelCalibrationOptions& options);

/// The stated constants, and those of starts by places that are far better, the best first.
[[nodiscard]] std::vector<std::vector<double>> likely_starts(
    const std::vector<DrivenRecording>& recordings, const Model& model,
    const WheelCalibrationOptions& options);

/// Of a robot that steers. Throws as calibrate_wheels does.
[[nodiscard]] WheelCalibration calibrate_steered(const std::vector<DrivenRecording>& recordings,
                                                 const Model& model,
                                                 const WheelCalibrationOptions& options);

}  // namespace trussmap::calibration
