// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a fit is strained: the chi^2 locked in legs, routes and landmarks.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/compare.hpp"

#include <vector>

namespace trussmap::criticism {

/// All of them, worst first.
struct Misfits {
  std::vector<LegMisfit> legs;
  std::vector<RouteMisfit> routes;
  std::vector<LandmarkMisfit> landmarks;
};

/// `tests` are of this fit.
[[nodiscard]] Misfits find_misfits(const fitting::FitState& fit, const ScoreTest& tests,
                                   const LegOptions& options);

}  // namespace trussmap::criticism
