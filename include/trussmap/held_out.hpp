// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// How well a model predicts legs that no fit has seen.
//
//   legs, numbered through all sessions:   0 1 2 3 4 | 5 6 7 8 9 | 10 ...      blocks of five
//   held out, share 0.3:                   blocks 3, 6, 9, 13, ...: by the number alone
//
// Landmark positions and coefficients come from the other legs (survey, truth). A held-out leg is
// predicted one step ahead: a Kalman filter follows the robot with all that it measured up to the
// leg's start, then with wheels and compass alone to its end, which is compared with where its
// landmark is (its truth row, where there are no sightings).
//
//   start landmark as sighted o----------------> * end landmark as predicted
//                              \  stretch s, orientation     | arrival error
//                               '--------------------------> x where it is (s0, theta0)
#pragma once

#include "trussmap/fit_model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace trussmap {

struct LegOptions {
  double min_drive = 0.25;  ///< m of driven path: legs between sightings are at least this long
  double leg = 1.0;         ///< m of driven path: legs between truth rows reach this
  double share = 0.3;       ///< of the legs held out, in [0, 1)
};

struct LegPrediction {
  std::size_t leg = 0;  ///< its number among all legs
  std::string from;     ///< landmarks; empty for truth rows
  std::string to;
  double t = 0.0;                           ///< s, at its end
  Vector2 arrival_error = Vector2::Zero();  ///< predicted - true, m
  /// m, the root mean square of |arrival_error| that the model's noise lets one expect.
  double expected_error = 0.0;
  double stretch_error = 0.0;      ///< |s - s0|/s0
  double orientation_error = 0.0;  ///< |theta - theta0|, rad
  bool has_chord = true;           ///< false: shorter than 0.1 m, counts for the arrival only
};

struct HeldOutMetrics {
  double arrival_rms = 0.0;        ///< m; 0 without legs
  double stretch_error = 0.0;      ///< mean of the legs' |s - s0|/s0
  double orientation_error = 0.0;  ///< mean of their |theta - theta0|, rad
};

struct HeldOut : HeldOutMetrics {
  /// m; what `arrival_rms` would be if the model were right and its noise as large as it states:
  /// no effect takes the error below it.
  double expected_rms = 0.0;
  std::vector<LegPrediction> legs;
};

/// Coefficients are estimated anew without the held-out legs, from these recordings, of which `fit`
/// is. Those that the other legs cannot show stay as they are; legs to landmarks that neither
/// another leg sees nor a survey knows are passed over, and legs that are partly in times that the
/// fit excludes (FitOptions::excluded). Throws like fit_model.
[[nodiscard]] HeldOut predict_held_out(const std::vector<DrivenRecording>& recordings,
                                       const ModelFit& fit, const LegOptions& legs = {});
[[nodiscard]] inline HeldOut predict_held_out(const std::vector<Recording>& recordings,
                                              const ModelFit& fit, const LegOptions& legs = {}) {
  return predict_held_out(with_wheels(recordings, fit.model.robot), fit, legs);
}

}  // namespace trussmap
