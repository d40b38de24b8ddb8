// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What adding one effect after the other misses: two that hide each other, of which neither
// explains anything by itself, or a proxy that comes first for what two others do together.
#pragma once

#include "criticism/known_causes.hpp"
#include "criticism/weighed_sets.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::criticism {

struct MaskedSet {
  std::vector<std::size_t> tested;  ///< places of its effects; empty: there is none
  double p_adjusted = 1.0;          ///< Bonferroni's, over all sets of as many
};

/// Effects that are significant together where none is by itself: of all sets of up to three, by
/// the noise that the best leaves, or that of the very rows that speak for it, at a fifth of the
/// level, and each of them surely there beside the others. A single event that has the better
/// claim comes first.
[[nodiscard]] MaskedSet masked_set(const std::vector<Tested>& tested, const SearchGround& ground);

/// The set of most evidence, where it is well ahead of what was found (20 to 1) and each of its
/// effects surely there beside the others; else what was found.
[[nodiscard]] std::vector<std::size_t> better_set(const std::vector<std::size_t>& found,
                                                  const std::vector<Tested>& tested,
                                                  const SearchGround& ground);

/// Of whitened columns of plain candidates, the two that explain most together; none where that
/// could be chance among all pairs (p < `level`).
[[nodiscard]] std::vector<std::size_t> masked_pair(CandidateGram gram,
                                                   const std::vector<Tested>& tested,
                                                   const SetGround& ground, double level);

}  // namespace trussmap::criticism
