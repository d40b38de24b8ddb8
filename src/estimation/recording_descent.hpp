// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Downhill in a recording problem: Gauss-Newton steps, damped (Levenberg-Marquardt) where a step
// does not pay, so that chi^2 never rises; and a look at the bottom: is it a point or a valley?
#pragma once

#include "estimation/recording_system.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct RecordingDescentOptions {
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< relative decrease of chi^2 that a next step may still promise
};

struct RecordingDescent {
  RecordingState state;
  Eigen::VectorXd coefficients;
  double chi2 = 0.0;
  int iterations = 0;  ///< steps taken
  bool converged = false;
};

/// The system is left linearised at the result.
[[nodiscard]] RecordingDescent descend(RecordingSystem& system, RecordingState state,
                                       Eigen::VectorXd coefficients,
                                       const RecordingDescentOptions& options = {});

/// Nodes that can move without changing any measurement, most mobile first; none if all is
/// determined. The system must be linearised.
[[nodiscard]] std::vector<int> find_loose_nodes(RecordingSystem& system,
                                                const RecordingProblem& problem);

/// Coefficients that the measurements cannot determine, alone or together. Call after factorise,
/// also where that failed by the coefficients.
[[nodiscard]] std::vector<int> find_undetermined(const RecordingSystem& system);

}  // namespace trussmap
