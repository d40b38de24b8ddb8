// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wrong sightings: a label misread, a landmark that somebody moved for a while; fixes by an echo;
// loops that take one place for another. All that follows of sightings holds of these as well.
//
// Minimises sum min(r^2, c^2) over the sightings plus the plain squares of all else, by graduated
// non-convexity (robust_weights.hpp, which says what r^2, c^2 and the weights are), in stages:
//
//   heed     landmarks go to where most of their sightings have them
//   narrow   Geman and McClure's weights, their c from 16 times as wide (in sds) down to the one
//            wanted. Wrong sightings are few, and each contradicts all others; where more than
//            `most_left_out` are beyond c (of loops: more than half), it is the model that is
//            wrong, and c stays wider: the noise counts as that much larger. Where even the widest
//            leaves out too many, none is left out.
//   harden   the cost is bent, step by step, into the truncated one; then what is out is asked
//            once more
//
// Each landmark keeps the sighting that suits it best, and each session one that ties it.
#pragma once

#include "estimation/recording_descent.hpp"

#include <vector>

namespace trussmap::estimation {

/// Rounds of Geman and McClure's weights of what may be wrong (1 of all else), each at the fit of
/// the round before. The last weights stay set in the system.
[[nodiscard]] RecordingDescent descend_softly(RecordingSystem& system,
                                              const RecordingProblem& problem, RecordingDescent fit,
                                              double gate, int rounds,
                                              const linalg::DescentOptions& options);

/// Share of what may be wrong, loops apart, whose squared error is beyond a limit.
[[nodiscard]] double share_beyond(const RecordingProblem& problem,
                                  const std::vector<double>& squared_errors, double limit);

/// A landmark whose first sighting was wrong lies where hardly any other sighting has it: it moves
/// to where most of them do. Where as many have it elsewhere, it leaves a place that is another
/// landmark's: a wrong name is read at a landmark.
void follow_majority(const RecordingProblem& problem, RecordingState& state);

struct RobustDescentOptions {
  double gate = 0.0;           ///< c^2
  double most_left_out = 1.0;  ///< share of the sightings
};

struct RobustFit {
  RecordingState state;
  Eigen::VectorXd coefficients;
  std::vector<double> weights;  ///< per measurement, 0 or 1
  double gate = 0.0;            ///< c^2 at last; infinity: none left out, whatever it is like
};

/// Descends with each sighting's weight bent towards 0 or 1, and leaves these weights set in the
/// system; with them descend once more.
[[nodiscard]] RobustFit descend_robustly(RecordingSystem& system, const RecordingProblem& problem,
                                         RecordingState state, Eigen::VectorXd coefficients,
                                         const RobustDescentOptions& options);

/// From a fit by nearly the same system, with its gate: sightings go out and come back in until
/// nothing changes. One that is out comes back where all of chi^2 would rise by less than c^2.
[[nodiscard]] RobustFit look_again(RecordingSystem& system, const RecordingProblem& problem,
                                   RobustFit fit);

}  // namespace trussmap::estimation
