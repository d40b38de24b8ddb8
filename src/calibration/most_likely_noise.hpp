// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheel noise of greatest restricted likelihood (trussmap/calibrate.hpp), all else as the model has
// it. At each (k_L, k_R) the adjustment starts from the last one, so that it takes few steps.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/planar.hpp"

#include <optional>
#include <vector>

namespace trussmap::calibration {

struct WheelNoiseFit {
  Vector2 k = Vector2::Zero();   ///< k_L, k_R, m^(1/2)
  Vector2 sd = Vector2::Zero();  ///< standard errors, by the curvature of the likelihood
};

/// `corrected`: recordings with the model's effects taken out. The search (fit/noise_search.hpp)
/// starts from the model's noise and goes no further than a factor of 150 either way. None where
/// the likelihood has no maximum there: other noise hides that of the wheels.
[[nodiscard]] std::optional<WheelNoiseFit> most_likely_noise(
    const std::vector<DrivenRecording>& corrected, const Model& model,
    const estimation::ProblemOptions& options, const estimation::EffectParameters& parameters,
    const estimation::RecordingState& start);

}  // namespace trussmap::calibration
