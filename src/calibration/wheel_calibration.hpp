// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheels and wheelbase from any recordings with truth or survey: calibration by adjustment.
//
//   E_d   right over left wheel diameter     effect `difference`, g = 2 (E_d - 1)/(E_d + 1)
//   E_b   actual over nominal wheelbase      effect `turn`,       g = 1/E_b - 1
//   E_s   true over measured travel          effect `wheels`,     g = E_s - 1
//   k     wheel noise: variance of a wheel's travel = k^2 |travel|        m^(1/2)
//
// The three are coefficients of the adjustment's border; rows are corrected and fitted again until
// they are exact. k_L and k_R maximise the restricted likelihood (Patterson & Thompson 1971), which
// does not mistake what the unknowns absorb for little noise:
//
//   -2 log L = sum log det C + log det (J' C^-1 J) + chi^2
//
// all other noise as the model has it. What the motion cannot determine is named, not guessed: what
// would have a standard error above a tenth counts as that.
//
// How the truth sits on the drive (truth_alignment.hpp) is estimated along with it: a truth that is
// late, or whose clock drifts, bends all of the above.
#pragma once

#include "calibration/truth_alignment.hpp"
#include "estimation/recording_adjustment.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct Calibrated {
  double value = 1.0;
  double sd = 0.0;
};

struct WheelCalibration {
  std::optional<Calibrated> diameter_ratio;   ///< E_d; none: the motion cannot determine it
  std::optional<Calibrated> wheelbase_ratio;  ///< E_b
  std::optional<Calibrated> scale;            ///< E_s
  std::optional<Calibrated> noise_left;       ///< k_L, m^(1/2)
  std::optional<Calibrated> noise_right;
  Model model;  ///< the given one with all of that in it
  TruthAlignment truth;
  double chi2 = 0.0;
  int dof = 0;
  std::vector<std::string> undetermined;  ///< what could not be found, and why
};

struct WheelCalibrationOptions {
  ProblemOptions problem;
  bool noise = true;  ///< find k_L and k_R too
  /// Of each recording, where several are stretches of one drive; empty: each is its own.
  std::vector<int> sessions;
};

/// Effects of `model` other than the three are taken out of the recordings first. Throws SolveError
/// where nothing can be determined, std::invalid_argument on effects that cannot be applied.
[[nodiscard]] WheelCalibration calibrate_wheels(const std::vector<Recording>& recordings,
                                                const Model& model,
                                                const WheelCalibrationOptions& options = {});

}  // namespace trussmap
