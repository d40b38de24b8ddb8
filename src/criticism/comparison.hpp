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

namespace trussmap {

/// `tests` are of this fit. `known_missing` spares the search for a missing effect: its name, empty
/// where none is missing.
[[nodiscard]] Comparison compare(const std::vector<Recording>& recordings, const ModelFit& fit,
                                 const CompareOptions& options, const ScoreTest& tests,
                                 const std::optional<std::string>& known_missing = {});

}  // namespace trussmap
