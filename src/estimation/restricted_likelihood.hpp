// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Restricted likelihood of what was recorded, as a function of the noise by which its rows are
// whitened: all unknowns are integrated out.
//
//   S    covariance of the rows                          X    their derivatives by the unknowns
//
//   -2 log R = log|S| + log|X' S^-1 X| + least chi^2     but for constants
//
// With states of lasting noise as further unknowns, log|S| is the sum of the logarithms of all
// rows' variances, those of the states among them (Patterson & Thompson 1971; Henderson 1950;
// Harville 1977).
#pragma once

#include "estimation/recording_system.hpp"

namespace trussmap::estimation {

struct RestrictedLikelihood {
  double without = 0.0;      ///< -2 log R without the further columns
  double taken = 0.0;        ///< chi^2 that these take away
  double information = 0.0;  ///< log|their information|

  /// -2 log R with the columns' sizes integrated out like all unknowns.
  [[nodiscard]] double integrated() const { return without - taken + information; }
  /// With their sizes at their likeliest: to compare with none, or with others.
  [[nodiscard]] double at_likeliest() const { return without - taken; }
};

/// log|S| + log|X' S^-1 X| where the system is factorised. Measurements of weight 0 count for
/// nothing.
[[nodiscard]] double log_determinants(const RecordingSystem& system,
                                      const RecordingProblem& problem);

/// The least chi^2 is that of the problem linearised at the state: one step of Gauss-Newton from
/// there. The system is left linearised there and factorised. `columns`: of what else may be in the
/// errors, whitened as the system's rows, a row each; none where there is nothing. `elsewhere`: -2
/// log R of what else the noise explains, which the rows do not have. Throws NotPositiveDefinite.
[[nodiscard]] RestrictedLikelihood restricted_likelihood(RecordingSystem& system,
                                                         const RecordingProblem& problem,
                                                         const RecordingState& state,
                                                         const Eigen::VectorXd& coefficients,
                                                         const Eigen::MatrixXd& columns = {},
                                                         double elsewhere = 0.0);

}  // namespace trussmap::estimation
