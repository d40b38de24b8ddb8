// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The rule by which a fit is consistent (trussmap/compare.hpp), for compare, diagnose and discover.
#pragma once

#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"

#include <vector>

namespace trussmap::criticism {

/// Whether chi^2 as a whole, or else a trend, is significant at this level: Bonferroni's rule for
/// the two. Objection::effect is another question (effect_search.hpp).
[[nodiscard]] Objection misfit_of(double p_value, const std::vector<Trend>& trends, double level);

/// Noise that would have to be larger than any explains nothing: where nothing is missing beside it
/// the verdict becomes an unexplained misfit.
void object_to_noise(const FittedNoise& noise, Diagnosis& diagnosis);

}  // namespace trussmap::criticism
