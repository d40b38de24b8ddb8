// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Scores of single events, g' (M' P M)^-1 g: those within one measurement from its own block of P,
// the others by solves that are shared.
#pragma once

#include "criticism/single_events.hpp"
#include "fit/fit_projection.hpp"

#include <vector>

namespace trussmap::criticism {

/// What a place explains, against the dispersion that it leaves.
struct Found {
  double score = 0.0;  ///< chi^2 that it explains
  int dof = 0;
  double log_p = 0.0;    ///< natural logarithm of the p-value
  Eigen::VectorXd size;  ///< of the dummies' coefficients; 0 where unseen
};

struct Scored {
  std::vector<Found> places;
  double tried = 0.0;  ///< independent tests that they are worth
};

/// One per event. `projection` is that of the fit itself.
[[nodiscard]] std::vector<Scored> score_events(const fitting::FitState& fit,
                                               const estimation::RecordingSystem& system,
                                               const fitting::FitProjection& projection,
                                               const std::vector<SingleEvent>& events);

}  // namespace trussmap::criticism
