// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What else it could be, and what would tell: one rule for headlines and rows.
#pragma once

#include "trussmap/evidence.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::report {

struct NearRival {
  const Finding* finding = nullptr;
  double behind = 0.0;  ///< chi^2 by which it explains less
};

/// Findings beside `first` that held-out legs cannot tell from it: predicted to leave the same
/// error, to within a millimetre, and at least half of what `first` gains. Neither its look-alikes
/// nor what is missing besides; of several forms of one effect the first.
[[nodiscard]] std::vector<NearRival> near_rivals(const Diagnosis& diagnosis, const Finding& first);

/// What of both kinds there is, or that there is none.
[[nodiscard]] std::vector<std::string> rival_sentences(const Effect& effect,
                                                       const std::vector<LookAlike>& alike,
                                                       const std::vector<NearRival>& near);

/// "hard iron (±2.9°), or body tilt, or cross-slope creep; and wheelbase (3 %)": every effect with
/// those that these recordings cannot tell from it. Those that are hardly seen beside the first are
/// counted. `alike` has one list per effect.
[[nodiscard]] std::string named_with_rivals(const std::vector<EffectEvidence>& effects,
                                            const std::vector<std::vector<LookAlike>>& alike);

/// The first lack whose drive could still show something: not one that only helps to see effects
/// that are ruled out already.
[[nodiscard]] std::optional<DataLack> lack_to_mend(const Diagnosis& diagnosis);

/// What to drive where nothing is missing.
[[nodiscard]] std::string drive_that_shows_more(const Diagnosis& diagnosis);

}  // namespace trussmap::report
