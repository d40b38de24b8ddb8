// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Did something happen once? A bump in one leg, a landmark moved, a wrong sighting, a session that
// is not like the others: each is a few columns beside the fit, tested as effects are
// (score_test.hpp), but that its rows are few.
//
//   M   whitened rows of the event's dummies     P   1 - the hat matrix of all unknowns
//   g = M' r,  S = M' P M,  score = g' S^-1 g: the chi^2 that allowing for it takes away
//
//   kind       dummies                                                              dof    tried
//   leg        a jump in one wheel's travel, at five places of each of its drives   1
//              any motion beyond the record, half-way through any of its segments     3      all
//              these
//   landmark   a step of its place from one session on                              2
//              from one visit of a session on                                       2      <= 16
//              its survey position                                                  2
//   sighting   what it says (data_snooping.hpp: the same statistic)                 1, 2
//   session    scales of travel and turn, compass offset, delay, of it alone        1 - 4
//
// Where several places are tried, the best counts, and its p-value is times the number of
// independent tests that they are worth (Galwey 2009). Scores are judged against the dispersion
// that the event leaves, phi = max(1, (chi^2 - score)/(dof - own)). What sits in one measurement's
// rows costs no solve (linalg/selected_inverse.hpp); only landmarks' steps and sessions do.
//
// One event shows in several places: a wrong sighting in the legs on both sides, a bump at a leg's
// end in the next one's turn. The one of least p-value - the likeliest for its freedom - comes
// first; ask for the next with the first conditioned on (`nuisance`). A landmark's step at its last
// visit is a wrong sighting and left to that; between sessions it is listed before the sighting.
//
// On 56 legs a bump of 5 sds (with which all else determines it), or a landmark moved by as much
// between two sessions, is first in nine of ten cases: one who is told the bump's row and wheel has
// it first in 95 of 100, since the largest of 140 chance events is in its way. From 6.5 sds on it
// is 98 to 100. Cost: linear in legs but for the landmarks' steps, a solve each.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"

#include <vector>

namespace trussmap::criticism {

struct TestedEvent : EventTest {
  std::vector<std::size_t> measurements;  ///< whose rows it touches; empty for a session
  Eigen::MatrixXd projected;  ///< rows x dummies, P M; empty (no columns) where p_adjusted >= 0.05
};

/// All events, the likeliest first. `nuisance`: projected columns of effects and events that are
/// taken as given. At most the first 64 keep their columns.
[[nodiscard]] std::vector<TestedEvent> test_events(const fitting::FitState& fit,
                                                   const ScoreTest& tests,
                                                   const Eigen::MatrixXd& nuisance = {});

}  // namespace trussmap::criticism
