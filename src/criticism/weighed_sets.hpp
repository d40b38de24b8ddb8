// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sets of tested candidates, weighed against each other (subset_search.hpp).
#pragma once

#include "criticism/subset_search.hpp"
#include "criticism/tested_candidate.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace trussmap::criticism {

/// What sets are asked of.
struct SetGround {
  const ScoreTest& tests;
  int dof = 0;           ///< of what is left
  int most = 5;          ///< effects in a set
  double window = 12.0;  ///< of log evidence
};

struct WeighedSets {
  CandidateGram gram;  ///< of those that are in a set; their places among all tested
  SetBelief belief;
  double dispersion = 1.0;         ///< phi, with the best set there
  std::vector<CandidateSet> sets;  ///< best first, the empty one among them

  /// Block of a candidate; none where it is in no set.
  [[nodiscard]] std::optional<int> block_of(std::size_t tested) const;
};

/// Candidates that look alike are one class, whose belief is that of its likeliest.
[[nodiscard]] SetBelief belief_in(const CandidateGram& gram, const std::vector<Tested>& tested,
                                  int most);

/// Screened by a second of driving at a time, then exactly those that are in any set within the
/// window. `also`: candidates that are to be weighed in any case.
[[nodiscard]] WeighedSets weigh_sets(const std::vector<Tested>& tested, const SetGround& ground,
                                     const std::vector<std::size_t>& also = {});

/// Sets of columns that are there already, weighed at the dispersion that the best of them leaves.
[[nodiscard]] WeighedSets weigh_sets(CandidateGram gram, SetBelief belief, const SetGround& ground);

/// phi = max(1, chi^2/dof) that a set leaves.
[[nodiscard]] double dispersion_beside(const CandidateGram& gram, const CandidateSet& set,
                                       const SetGround& ground);

}  // namespace trussmap::criticism
