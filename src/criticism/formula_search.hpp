// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Something is missing, and the best that was tried says so: is there a formula that says it
// better? Asked only where a candidate is significant already, so that formulas raise no false
// alarm.
//
//   channels     those of what explains nearly as much as the best
//   quick        each channel's formulas, at a second of driving at a time
//   refined      the constants of the most promising, then exact tests
//   evidence     as of all candidates
#pragma once

#include "criticism/formulas.hpp"
#include "criticism/tested_candidate.hpp"

#include <vector>

namespace trussmap::criticism {

/// What a search has left, and the best that it found there.
struct FormulaGround {
  const fitting::FitState& fit;
  const ScoreTest& left;
  int dof = 0;    ///< of what is left
  int tried = 0;  ///< tests in all, before
  double level = 0.0;
};

struct FormulasTried {
  /// Best first, and only where it comes before `best`; those after it explain nearly as much.
  std::vector<Tested> better;
  int tried = 0;
};

/// `still`: all that was tried before, asked of what is left; `best` is of these.
[[nodiscard]] FormulasTried formulas_beside(const Tested& best, const std::vector<Tested>& still,
                                            const FormulaGrammar& grammar,
                                            const FormulaGround& ground);

}  // namespace trussmap::criticism
