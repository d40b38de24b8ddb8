// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How the truth sits on the drive: where on the robot it tracks, where it believes ahead to be, and
// how its clock runs. Nobody measures these, yet each of them looks like wheel errors.
//
//   ahead, left   the tracked point, from the axle's centre      m, robot axes     all recordings
//   heading       truth's heading less the robot's               rad               all recordings
//   late          truth rows are stamped late by this at the     s                 each session
//                 session's start,
//   clock         and by so much more per second                 s/s               each session
//
// A late row shows the robot where it was: its pose less the way driven since, by the wheels. That
// is linear in the lateness while the motion is steady; about a lateness believed already it is
// exact everywhere, so fits are repeated.
#pragma once

#include "estimation/effect_parameters.hpp"

#include <map>

namespace trussmap {

/// The clock of one session.
struct TruthClock {
  double late = 0.0;   ///< s, at `start`
  double drift = 0.0;  ///< s/s
  double start = 0.0;  ///< s, where the session's drive starts
};

struct TruthAlignment {
  double ahead = 0.0;                ///< m
  double left = 0.0;                 ///< m
  double heading = 0.0;              ///< rad
  std::map<int, TruthClock> clocks;  ///< by session; none where no truth was used
};

/// Coefficients of all that, in this order, late and clock by turns, sessions in rising order. Weak
/// priors keep what a motion does not show near 0. None where no recording has truth. `sessions`:
/// of each recording, where several are stretches of one drive; empty: 0, 1, 2 ... `believed`: what
/// an earlier fit has found.
[[nodiscard]] EffectParameters truth_alignment(const std::vector<Recording>& recordings,
                                               const Robot& robot, const std::vector<int>& sessions,
                                               const TruthAlignment& believed = {});

/// The coefficients of that border, read.
[[nodiscard]] TruthAlignment alignment_of(const std::vector<Recording>& recordings,
                                          const std::vector<int>& sessions,
                                          const Eigen::VectorXd& coefficients);

/// Recordings, session after session, with their truth moved to where it shows the axle's centre
/// at the time it is stamped.
[[nodiscard]] std::vector<Recording> aligned(const std::vector<Recording>& recordings,
                                             const TruthAlignment& alignment, const Robot& robot);

}  // namespace trussmap
