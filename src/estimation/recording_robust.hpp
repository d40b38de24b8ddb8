// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wrong sightings: a label misread, a landmark that somebody moved for a while.
//
//   r^2    squared whitened error of a sighting
//   c^2    the largest r^2 that a right one should have: `gate`
//   w      a sighting's weight, 0 ... 1
//
// Minimises sum min(r^2, c^2) over the sightings plus the plain squares of all else, by graduated
// non-convexity (Yang, Antonante, Tzoumas & Carlone, "Graduated non-convexity for robust spatial
// perception", 2020): first all sightings pull nearly alike, then the cost is bent, step by step,
// into the truncated one. Each landmark keeps the sighting that suits it best.
#pragma once

#include "estimation/recording_descent.hpp"

#include <vector>

namespace trussmap {

/// Weights of Geman and McClure for sightings, (gate/(r^2 + gate))^2, and 1 for all else.
[[nodiscard]] std::vector<double> soft_weights(const RecordingProblem& problem,
                                               const std::vector<double>& squared_errors,
                                               double gate);

/// Descends with each sighting's weight bent towards 0 or 1, and leaves these weights set in the
/// system. Returns the values reached; with the final weights descend once more.
struct RobustFit {
  RecordingState state;
  Eigen::VectorXd coefficients;
  std::vector<double> weights;  ///< per measurement, 0 or 1
};
[[nodiscard]] RobustFit reduce_nonconvexity(RecordingSystem& system,
                                            const RecordingProblem& problem, RecordingState state,
                                            Eigen::VectorXd coefficients, double gate);

}  // namespace trussmap
