// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// Gates against wrong measurements: how far off a measurement may be before it is left out. All
// defaults stand here.
//
//   estimator                  what is gated, and against what                     default
//   map from recordings        a sighting, against the best fit of all others;     4 sd
//                              in its own standard deviations. More where too
//                              many would go
//   compare, fit, diagnose,    the same, however many go                           0: no gate
//   discover
//   map builder, gauss_markov  an arrival, against the map as it stands; in        8 sd
//                              standard deviations of leg and map jointly, and
//                              of what misfits have been lately
//   robust pose graph          a loop closure; e' Omega e, which is squared,       16.27
//                              against the best fit of all others
//
// The rule behind them: a map is wanted in spite of wrong sightings, so that building one gates by
// default, and a map that is not yet complete needs the wider gate. Neither takes a model that is
// wrong for many wrong sightings. A model is judged by the measurements that contradict it: there
// the gate holds as long as few are beyond it, and widens where a gate would hide what is looked
// for. 16.27 is the 0.999 quantile of chi^2 with 3 degrees of freedom.
#pragma once

namespace trussmap {

inline constexpr double kMapGate = 8.0;          ///< standard deviations
inline constexpr double kAdjustmentGate = 4.0;   ///< standard deviations of the sighting
inline constexpr double kModelGate = 4.0;        ///< standard deviations; 0: no gate
inline constexpr double kMostLeftOut = 0.12;     ///< share of the sightings; more widen the gate
inline constexpr double kPoseGraphGate = 16.27;  ///< squared: chi^2

}  // namespace trussmap
