// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is known of the map while session after session joins it.
#pragma once

#include "estimation/laid_session.hpp"
#include "estimation/problem_part.hpp"

namespace trussmap::estimation {

struct MapSoFar {
  PlacedLandmarks landmarks;
  KnownOrientations orientations;
};

[[nodiscard]] MapSoFar surveyed_map(const RecordingProblem& problem);

/// A session in a frame of its own, laid over landmarks that have their place, and over
/// orientations that are known.
[[nodiscard]] LaidSession lay_over(const MapSoFar& known, const ProblemPart& session,
                                   LaidSession laid);

/// The map with the landmarks that a session has placed, and with orientations as it first reads
/// them: with a compass, too.
[[nodiscard]] MapSoFar with_session(MapSoFar known, const RecordingProblem& problem,
                                    const PoseSpan& span, const ProblemPart& session,
                                    const LaidSession& laid);

}  // namespace trussmap::estimation
