// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Downhill in a recording problem, and a look at the bottom: is it a point or a valley?
#pragma once

#include "estimation/recording_system.hpp"
#include "linalg/levenberg_marquardt.hpp"

#include <string>
#include <vector>

namespace trussmap::estimation {

/// A decrease of chi^2 that is nothing, however small chi^2 is.
inline constexpr double kNegligibleDecrease = 1e-10;

struct RecordingDescent {
  RecordingState state;
  Eigen::VectorXd coefficients;
  double chi2 = 0.0;
  int iterations = 0;  ///< steps taken
  bool converged = false;
};

/// Levenberg-Marquardt. The system is left linearised at the result.
[[nodiscard]] RecordingDescent descend(RecordingSystem& system, RecordingState state,
                                       Eigen::VectorXd coefficients,
                                       const linalg::DescentOptions& options = {
                                           100, 1e-12, kNegligibleDecrease});

/// Nodes that can move without changing any measurement, most mobile first; none if all is
/// determined. The system must be linearised.
[[nodiscard]] std::vector<int> find_loose_nodes(RecordingSystem& system);

/// Coefficients that the measurements cannot determine, alone or together. Call after factorise,
/// also where that failed by the coefficients.
[[nodiscard]] std::vector<int> find_undetermined(const RecordingSystem& system);

}  // namespace trussmap::estimation
