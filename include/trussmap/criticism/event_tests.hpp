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
//   kind       dummies                                                             dof    tried
//   leg        motion beyond the record (ahead, left, turn) in one of its pieces   3      its
//   pieces landmark   a step of its place from one session on; from one visit on          2 the
//   visits
//              its survey position                                                 2
//   sighting   what it says (data_snooping.hpp: the same statistic)                1, 2
//   session    scales of travel and turn, compass offset, delay, of it alone       1 - 4
//
// A leg's turn happens half-way through the piece, as far as the compass's mean is concerned. Where
// several places are tried, the best counts and its p-value is times their number. Scores are
// judged against the dispersion that the event leaves, phi = max(1, (chi^2 - score)/(dof - own)).
// What sits in the fit's rows alone costs no solve (truss/selected_inverse.hpp); only landmarks'
// steps and sessions do.
//
// One event shows in several places: a wrong sighting in the legs on both sides, a bump in the
// sightings around it. The one of least p-value - the likeliest for its freedom - comes first; ask
// for the next with the first taken out (`aside`). A step at a landmark's last visit is a wrong
// sighting; in a session's only visit, too, and is then listed before it.
#pragma once

#include "trussmap/criticism/score_test.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct EventTest {
  std::string kind;      ///< leg, landmark, sighting, session
  std::string name;      ///< "12 -> 13 at t = 45.2 s", "12", "run 3"
  std::string in_words;  ///< what it says of the robot or the place
  double score = 0.0;
  int dof = 0;
  double p_value = 1.0;                   ///< of score/phi, times the places tried for this event
  double p_adjusted = 1.0;                ///< Holm, over all events
  std::vector<std::size_t> measurements;  ///< whose rows it touches; empty for a session
  Eigen::MatrixXd projected;  ///< rows x dummies, P M; empty (no columns) where p_adjusted >= 0.05
};

/// All events, the likeliest first. `aside`: projected columns of effects and events that are taken
/// as given. At most the first 64 keep their columns.
[[nodiscard]] std::vector<EventTest> test_events(const ModelFit& fit, const ScoreTest& tests,
                                                 const Eigen::MatrixXd& aside = {});

}  // namespace trussmap
