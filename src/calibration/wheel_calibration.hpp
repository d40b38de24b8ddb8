// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Calibration of the wheels (trussmap/calibrate.hpp) from parts of recordings.
#pragma once

#include "estimation/recording_problem.hpp"
#include "trussmap/calibrate.hpp"

#include <vector>

namespace trussmap {

struct WheelCalibrationOptions {
  ProblemOptions problem;
  bool noise = true;  ///< estimate k_L and k_R too
  /// Of each recording, where several are segments of one drive; empty: each is its own.
  std::vector<int> sessions;
};

[[nodiscard]] WheelCalibrationOptions calibration_options(const CalibrationOptions& options);

[[nodiscard]] WheelCalibration calibrate_wheels(const std::vector<DrivenRecording>& recordings,
                                                const Model& model,
                                                const WheelCalibrationOptions& options);

}  // namespace trussmap
