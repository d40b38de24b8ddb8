// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map of `build --method adjustment`: all measurements of the recordings at once.
//
//   recordings --make_problem--> problem --adjust, gated--> landmarks, covariances
//        \--map_recordings, guided by these landmarks--> legs and routes
//
// The recording adjustment gives the positions; the map builder, which takes its headings from
// them, gives the routes. Survey and truth have no part in either.
#pragma once

#include "build_map/recording_map.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

struct AdjustedMap {
  RecordingMap map;  ///< `rejected` are the sightings that the adjustment left out
  double chi2 = 0.0;
  int dof = 0;
  double p_value = 1.0;
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> warnings;
};

/// `gate` in standard deviations of a sighting: what exceeds it at the best fit of the others is
/// left out. `options` are the map builder's, for the routes. Throws InputError and SolveError as
/// adjust() and map_recordings() do.
[[nodiscard]] AdjustedMap map_by_adjustment(const std::vector<Recording>& recordings,
                                            const Model& model, double gate,
                                            RecordingMapOptions options);

}  // namespace trussmap::app
