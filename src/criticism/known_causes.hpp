// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Two known effects at once may look like one odd curve: a travel scale and ticks that are missed
// at speed are both the left wheel's error "with a curve of speed", and the curve explains more
// than either of them alone. What a search has found by way of a free form is therefore held
// against the catalogue's effects taken together.
#pragma once

#include "criticism/tested_candidate.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::criticism {

/// What is being searched: a fit's effects, asked of what is left of its residuals.
struct SearchGround {
  const fitting::FitState& fit;
  const ScoreTest& tests;
  int dof = 0;    ///< of what is left
  int tried = 0;  ///< tests in all
  double level = 0.0;
  double next_level = 0.0;  ///< of all but the first
  double next_share = 0.0;  ///< of the chi^2 explained before, that a next one has to explain
  std::size_t most = 0;
};

/// An effect by its place among those tested, with parameters of its own.
struct KnownCause {
  std::size_t tested = 0;
  Candidate candidate;
};

/// Effects of the catalogue that have more evidence together than `found`, best first; empty where
/// there are none, or where nothing found is a free form.
[[nodiscard]] std::vector<KnownCause> known_causes_of(const std::vector<std::size_t>& found,
                                                      const std::vector<Tested>& tested,
                                                      const SearchGround& ground);

}  // namespace trussmap::criticism
