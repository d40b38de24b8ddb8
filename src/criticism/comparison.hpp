// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The comparison of a fit (trussmap/compare.hpp) where its score tests are there already.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/compare.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::criticism {

/// What need not be found anew.
struct KnownOfFit {
  /// Name of the missing effect, empty where there is none.
  std::optional<std::string> missing = {};
  std::optional<HeldOut> held_out = {};
};

/// `tests` are of this fit.
[[nodiscard]] Comparison compare(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit, const CompareOptions& options,
                                 const ScoreTest& tests, KnownOfFit known = {});

}  // namespace trussmap::criticism
