// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far dead reckoning goes wrong within a fixed time, judged by a fit's own smoothed path: what
// a leg's arrival says less and less of the better the wheels are against the sightings.
//
//   smoothed   o----------------> o      both from the same pose; every half horizon anew, where
//   reckoned   o-----------> x           the robot has sighted something within a second of
//                                        either end
//
// By blocked cross-validation (blocked_coefficients.hpp): a window is reckoned with the
// coefficients that the fit has without what was sighted in the window's block, so that an effect
// is not judged by the sightings that it was fitted to.
#pragma once

#include "fit/fit_state.hpp"

#include <vector>

namespace trussmap::validation {

struct HorizonError {
  double rms = 0.0;  ///< m; 0 without windows
  int windows = 0;
};

struct HorizonErrors {
  HorizonError after_10;  ///< s
  HorizonError after_30;
};

/// The fit has paths.
[[nodiscard]] HorizonErrors horizon_errors(const fitting::FitState& fit);
/// One for each of these horizons, s.
[[nodiscard]] std::vector<HorizonError> horizon_errors(const fitting::FitState& fit,
                                                       const std::vector<double>& horizons);

/// How another fit's dead reckoning compares.
struct HorizonChange {
  double share = 1.0;        ///< of the error, rms
  double rise_in_sds = 0.0;  ///< of the squared error, over its standard error by blocks of windows
  int windows = 0;
};

/// Both judged by the path of the fit `after`, of the same recordings, in the same windows.
[[nodiscard]] HorizonChange horizon_change(const fitting::FitState& before,
                                           const fitting::FitState& after, double horizon);

}  // namespace trussmap::validation
