// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The same problems given to Ceres: analytic Jacobians, SPARSE_NORMAL_CHOLESKY on SuiteSparse, one
// thread.
#pragma once

#include "grid_input.hpp"
#include "measure.hpp"
#include "trussmap/pose_graph.hpp"

#include <string>

namespace trussmap::bench {

/// Empty where this build has no Ceres; then the others throw std::logic_error.
[[nodiscard]] std::string ceres_version();

/// Least squares of all raw measurements; chi2.
[[nodiscard]] double fit_with_ceres(const Grid& grid, Stages& stages);

/// A pose graph from its file's start until chi2 is within `tolerance` of `optimum`, relatively,
/// or Ceres gives up; chi2.
[[nodiscard]] double fit_with_ceres(const PoseGraph& graph, double optimum, double tolerance,
                                    Stages& stages);

}  // namespace trussmap::bench
