// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far dead reckoning goes wrong within a fixed time, judged by a fit's own smoothed path: what
// a leg's arrival says less and less of the better the wheels are against the sightings.
//
//   smoothed   o----------------> o      both from the same pose; every half horizon anew, where
//   reckoned   o-----------> x           the robot has sighted something within a second of
//                                        either end
#pragma once

#include "fit/fit_state.hpp"

namespace trussmap {

struct HorizonError {
  double rms = 0.0;  ///< m; 0 without windows
  int windows = 0;
};

/// `horizon` in s. The fit has paths.
[[nodiscard]] HorizonError horizon_error(const FitState& fit, double horizon);

}  // namespace trussmap
