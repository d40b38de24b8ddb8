// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the robot was in every row, as an adjustment has it.
//
//   node o~~~~~~~~~> * node      rows are reckoned from node to node, with the effects; what is
//                      ^ missing  missing at the next node is shared out over the rows as white
//                                 noise of the wheels that adds up to it
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

#include <vector>

namespace trussmap::fitting {

struct SessionPath {
  Pose start;              ///< at the drive's start; map frame, heading not wrapped
  std::vector<Pose> ends;  ///< at the end of each row
  /// What each row's record lacks of forward travel (m) and turn (rad), as estimated: its
  /// noise. Empty: nothing.
  std::vector<Vector2> missing = {};
  /// What each row's gyro exceeds the wheels by (rad) beyond the effects: noise of both. Empty: no
  /// gyro.
  std::vector<double> excess = {};
};

/// One path per session. `offsets` are the coefficients of the border less their references. Before
/// the first node and after the last the robot is reckoned from there.
[[nodiscard]] std::vector<SessionPath> fitted_paths(const std::vector<DrivenRecording>& recordings,
                                                    const Robot& robot,
                                                    const estimation::RecordingProblem& problem,
                                                    const estimation::EffectParameters& border,
                                                    const Eigen::VectorXd& offsets,
                                                    const estimation::RecordingState& state);

/// The pose at time t, along the row.
[[nodiscard]] Pose pose_at(const MotionRows& drive, const SessionPath& path, double t);

}  // namespace trussmap::fitting
