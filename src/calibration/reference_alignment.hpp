// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How truth, fixes, the sensor of sightings and the scanner of loops are mounted, and how truth and
// fixes are clocked, as parameters of the adjustment. Few measure these, yet each of them looks
// like wheel errors.
//
//   ahead, left   how far off where it is stated to sit           m, robot axes    all recordings
//   heading       how far off where it is stated to look          rad              all recordings
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

namespace trussmap::calibration {

struct ReferenceAlignment {
  TruthAlignment truth;
  FixAlignment fixes;
  std::vector<CalibratedMounting> mountings;  ///< of each with its standard errors
};

/// What is used, and so may be asked where it sits.
struct ReferencesUsed {
  bool truth = true;
  bool fixes = true;
  bool sensor = true;   ///< sightings from afar
  bool scanner = true;  ///< loops
};
[[nodiscard]] ReferencesUsed references_in(const std::vector<DrivenRecording>& recordings,
                                           const estimation::ProblemOptions& used);

/// Coefficients of all that, of truth, fixes, sensor and scanner in turn, each in this order,
/// sessions in rising order, late and clock in turn. Weak priors keep what a motion does not show
/// near 0. None of what no recording has or is not used. `sessions`: of each recording, where
/// several are segments of one drive; empty: 0, 1, 2 ... `prior`: what an earlier fit has found.
[[nodiscard]] estimation::EffectParameters reference_alignment(
    const std::vector<DrivenRecording>& recordings, const ReferencesUsed& used,
    const std::vector<int>& sessions, const ReferenceAlignment& prior = {});

/// The estimated coefficients of those parameters and their covariance, read: places from the
/// axle's centre, what is surer than a place that is none (0.1 m, 0.1 rad).
[[nodiscard]] ReferenceAlignment alignment_of(const std::vector<DrivenRecording>& recordings,
                                              const Robot& robot, const ReferencesUsed& used,
                                              const std::vector<int>& sessions,
                                              const Eigen::VectorXd& coefficients,
                                              const Eigen::MatrixXd& covariance);

/// The places that were found, in [robot].
[[nodiscard]] Mountings with_found(Mountings mounted, const ReferenceAlignment& found);

/// Recordings, session after session, with their truth moved to where it shows the axle's centre
/// at the time it is stamped.
[[nodiscard]] std::vector<DrivenRecording> aligned(const std::vector<DrivenRecording>& recordings,
                                                   const TruthAlignment& alignment);

}  // namespace trussmap::calibration
