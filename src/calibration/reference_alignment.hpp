// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How truth and fixes are mounted and clocked, as parameters of the adjustment. Nobody measures
// these, yet each of them looks like wheel errors.
//
//   ahead, left   the point that they are of, from the axle's     m, robot axes    all recordings
//                 centre
//   heading       truth's heading less the robot's                rad              all recordings
//   late          rows are stamped late by this at the            s                each session
//                 session's start,
//   clock         truth's, and by so much more per second         s/s              each session
//
// A late row shows the robot where it was: its pose less the way driven since, by the wheels. That
// is linear in the lateness while the motion is steady, and exact about a lateness that is known
// already, so fits are repeated.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/calibrate.hpp"

#include <vector>

namespace trussmap {

struct ReferenceAlignment {
  TruthAlignment truth;
  FixAlignment fixes;
};

/// Coefficients of all that, truth's before the fixes', each in this order, sessions in rising
/// order, late and clock in turn. Weak priors keep what a motion does not show near 0. None of what
/// no recording has or is not used. `sessions`: of each recording, where several are segments of
/// one drive; empty: 0, 1, 2 ... `prior`: what an earlier fit has found.
[[nodiscard]] EffectParameters reference_alignment(const std::vector<DrivenRecording>& recordings,
                                                   const Robot& robot, const ProblemOptions& used,
                                                   const std::vector<int>& sessions,
                                                   const ReferenceAlignment& prior = {});

/// The estimated coefficients of those parameters, read.
[[nodiscard]] ReferenceAlignment alignment_of(const std::vector<DrivenRecording>& recordings,
                                              const ProblemOptions& used,
                                              const std::vector<int>& sessions,
                                              const Eigen::VectorXd& coefficients);

/// Recordings, session after session, with their truth moved to where it shows the axle's centre
/// at the time it is stamped.
[[nodiscard]] std::vector<DrivenRecording> aligned(const std::vector<DrivenRecording>& recordings,
                                                   const TruthAlignment& alignment,
                                                   const Robot& robot);

}  // namespace trussmap
