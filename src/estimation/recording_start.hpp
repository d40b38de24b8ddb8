// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A start for the adjustment of recordings that is near enough to the best fit.
//
// Session by session: the robot is reckoned from pose to pose; the compass, truth rows and
// landmarks already placed correct it on the way, and with it the coefficients of effects
// (pose_reckoner.hpp); a landmark is placed when it is first seen.
//
// That drifts too far to descend from. So a session is adjusted while it is laid down, first a
// stretch, then that stretch with the next one, each a third longer than the last:
//
//   |----|      reckon, adjust
//   |----|--|   reckon on from there, with the landmarks as adjusted; adjust all
//   |-------|---|  ...
//
// A careful start looks whether a stretch leaves many sightings beyond the gate: the robot was lost
// on it then; it is taken back, and a shorter one is laid. That costs much more.
//
// A landmark of which there are ranges alone is placed when the path so far tells where it is
// (multilateration.hpp), at the session's end where they have it most likely.
//
// Loops count from the stretch on that holds both their ends: those that contradict what was driven
// in between by more than its noise can be are left out.
//
// With fixes the session is reckoned in their frame all through, where there are as many as
// sightings; from the pose in which its first stretch suits most of them. Else it is laid over them
// when it is done.
//
// Without a compass yaws correct the reckoning too, by the orientations that landmarks have so far.
//
// At last the session is laid over the landmarks that are known by then (survey, other sessions):
// shifted, and without a compass turned, where they are fewer than three by their orientations.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

#include <limits>
#include <vector>

namespace trussmap::estimation {

struct StartOptions {
  double map_sd = 0.1;  ///< m per coordinate: how far off landmarks may be while laying down
  /// Squared standard deviations beyond which a sighting does not correct the reckoning, and
  /// counts less in the stretches' adjustments; infinity: all sightings are believed.
  double gate = std::numeric_limits<double>::infinity();
  int first_stretch = 30;  ///< poses
  bool careful = false;
};

struct RecordingStart {
  RecordingState state;
  Eigen::VectorXd coefficients;  ///< of the border's unknown ones
};

/// The border's unknown coefficients have finite priors.
[[nodiscard]] RecordingStart start_of(const RecordingProblem& problem,
                                      const EffectParameters& border,
                                      const StartOptions& options = {});

/// Dead reckoning alone, with the compass if there is one: no landmark corrects it, and each lies
/// at the mean of where its sightings put it. What the adjustment is compared with.
[[nodiscard]] RecordingState dead_reckoned(const RecordingProblem& problem);

/// Of landmarks with an orientation: surveyed, or the mean direction in which these poses have seen
/// it, rad.
[[nodiscard]] std::vector<double> orientations_seen_from(const RecordingProblem& problem,
                                                         const std::vector<Pose>& poses);

}  // namespace trussmap::estimation
