// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a recording problem, as problems of their own: a session, or a stretch of it.
#pragma once

#include "estimation/pose_reckoner.hpp"
#include "estimation/recording_problem.hpp"

#include <vector>

namespace trussmap::estimation {

/// Poses first ... first + count - 1.
struct PoseSpan {
  int first = 0;
  int count = 0;
};

/// Each session's poses.
[[nodiscard]] std::vector<PoseSpan> session_spans(const RecordingProblem& problem);

struct ProblemPart {
  RecordingProblem problem;
  std::vector<int> landmarks;     ///< of the whole problem, in the part's order
  std::vector<int> orientations;  ///< likewise, as numbered among the oriented
};

/// The part of a problem that some of one session's poses see, without survey, truth and fixes;
/// landmarks that they do not see are left out. With `placed`, sightings of landmarks that have no
/// place there are left out, too.
[[nodiscard]] ProblemPart part_of(const RecordingProblem& problem, const PoseSpan& span,
                                  const PlacedLandmarks* placed = nullptr);

/// All of a session, truth and fixes too. Yaws are left out where there is a compass: it tells
/// headings, and may be off by more than they are.
[[nodiscard]] ProblemPart session_of(const RecordingProblem& problem, const PoseSpan& span);

[[nodiscard]] bool has_compass(const RecordingProblem& problem);
[[nodiscard]] bool has_loops(const RecordingProblem& problem);

}  // namespace trussmap::estimation
