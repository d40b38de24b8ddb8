// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Candidates with their score tests, and which of them has the best claim.
#pragma once

#include "criticism/candidates.hpp"
#include "criticism/local_dispersion.hpp"
#include "criticism/score_test.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace trussmap::criticism {

/// A candidate's test, without its columns.
struct Tested {
  Candidate candidate;
  Score score;
  Eigen::MatrixXd slopes;  ///< of the held-out legs
  int tried = 1;
  /// Of the score, what the members tried had found before shape parameters were refined: all that
  /// is paid for by their number, and so all that speaks for there being an effect.
  double share_found = 1.0;
  double dispersion = 1.0;  ///< of the rows that speak for it
  double evidence = 0.0;
  double p_value = 1.0;
  double p_adjusted = 1.0;
};

/// Runs score tests chunk by chunk, so that no more than a chunk's columns are held.
void visit_scores(const ScoreTest& tests, const std::vector<Candidate>& candidates,
                  Resolution resolution,
                  const std::function<void(std::size_t candidate, Score& score)>& visit);

void drop_columns(Score& score);

/// Of a fit with this chi^2 and dof: p-values against the dispersion that each would leave, as a
/// whole and where it acts; evidence against the least there is. `tried`: tests in all.
void judge(std::vector<Tested>& tested, double chi2, int dof, int tried);

/// What speaks for a candidate that explains so much, in units of the noise: less what its
/// coefficients, parameters and oddness cost.
[[nodiscard]] double evidence_at(const Tested& one, double net);

/// Tests again, of what is left, those for which `wanted` holds; all of them without it.
void test_again(const fitting::FitState& fit, const ScoreTest& left, std::vector<Tested>& still,
                const std::function<bool(const Tested&)>& wanted = {});

/// How the rows scatter that speak for this score; 1 where hardly anything does.
[[nodiscard]] double dispersion_of(const Score& score, const LocalDispersion& local);

/// Whether it would have to be far larger than anything known; never so a plain factor: a wheelbase
/// may be given quite wrong.
[[nodiscard]] bool is_implausible(const Tested& one);

/// Evidence less what an implausible size costs: a prior that misfit does not widen, and once more
/// as much, for a proxy of what is missing is seldom of a possible size.
[[nodiscard]] double plausible_evidence(const Tested& one);

/// Of those that are significant at this level the one of most evidence, which an implausible size
/// weighs against; nullptr where there is none.
[[nodiscard]] const Tested* best_of(const std::vector<Tested>& tested, double level);

}  // namespace trussmap::criticism
