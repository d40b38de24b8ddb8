// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings as compare, fit, diagnose and discover take them: what of them counts as independent
// measurements.
//
//   recordings, model --prepare_recordings--> recordings, notes on what is left out and why
//
//   frames   where sightings come in dense frames, one frame in so long as their errors last
//            (lasting_errors, fit_model.hpp)
//   survey   points that contradict a map made of such frames without the survey
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/gate.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// The gate of gate.hpp, kModelGate, as long as few measurements are beyond it. `gate` in standard
/// deviations; 0: none.
[[nodiscard]] FitOptions gated_fit(double gate = kModelGate);

struct PreparedRecordings {
  std::vector<DrivenRecording> recordings;
  std::vector<std::string> notes;  ///< what of the recordings is not used, and why
};

/// Thinned out. `every`: s between frames of sightings; 0: all;
/// absent: as long as their errors are found to last. Throws like fit_model.
[[nodiscard]] PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings,
                                                    const Model& model, const FitOptions& fit,
                                                    std::optional<double> every = {});
[[nodiscard]] inline PreparedRecordings prepare_recordings(std::vector<Recording> recordings,
                                                           const Model& model,
                                                           const FitOptions& fit,
                                                           std::optional<double> every = {}) {
  return prepare_recordings(with_wheels(std::move(recordings), model.robot), model, fit, every);
}

}  // namespace trussmap
