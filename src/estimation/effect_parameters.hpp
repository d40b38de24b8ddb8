// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients of physical effects as further unknowns: what one unit of each does to every row of
// every drive, and to every view of a landmark, truth row or fix.
//
//   row of a drive   DrivePattern (channel_physics.hpp): advance, slip, turn, compass
//   view             the point that meets landmarks and carries the sensors lies `ahead` and
//                    `left` of the axle's centre, and looks `heading` further left; the readings
//                    are range (1 + range_scale) + range, and bearing + bearing
//   truth row        ahead, left, heading alike
//   fix              ahead, left, heading (by which the way ahead is turned), and x, y
//   loop             ahead, left, heading: in whose axes it tells the motion
//
// An effect is linear in its coefficient row by row; what rows add up to is not, and is computed
// anew at every coefficient. Effects change no covariance.
#pragma once

#include "estimation/segment_motion.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::estimation {

/// One coefficient. Per session a pattern per row (sighting, truth row, fix, loop), or none at all.
struct EffectPattern {
  std::string name;
  std::vector<std::vector<effects::DrivePattern>> drives;
  std::vector<std::vector<effects::ViewPattern>> sightings;
  std::vector<std::vector<effects::ViewPattern>> truths;
  double prior_sd = std::numeric_limits<double>::infinity();  ///< of the coefficient, about 0
  std::vector<std::vector<effects::ViewPattern>> fixes = {};
  std::vector<std::vector<effects::ViewPattern>> loops = {};
  std::optional<double> held = {};  ///< known at this value: acts, but is no unknown
  double reference = 0.0;  ///< of the coefficient, where the patterns leave all as recorded
};

/// All coefficients, in order. Those that are not held are the unknowns, in the same order.
using EffectParameters = std::vector<EffectPattern>;

/// Places in the border of the coefficients that are unknown.
[[nodiscard]] std::vector<int> unknown_coefficients(const EffectParameters& border);

/// All coefficients less their references, from the unknown ones.
[[nodiscard]] Eigen::VectorXd offsets_at(const EffectParameters& border,
                                         const Eigen::VectorXd& unknown);

/// What all coefficients together do to a session's rows; empty where they leave them as they are.
[[nodiscard]] std::vector<effects::DrivePattern> summed_patterns_of(const EffectParameters& border,
                                                                    const Eigen::VectorXd& offsets,
                                                                    std::size_t session);
/// Of each session.
[[nodiscard]] std::vector<std::vector<effects::DrivePattern>> summed_patterns(
    const EffectParameters& border, const Eigen::VectorXd& offsets, std::size_t sessions);

/// What each coefficient does to one session's rows, as segment_motion takes it; nullptr: nothing.
[[nodiscard]] std::vector<const std::vector<effects::DrivePattern>*> drive_patterns(
    const EffectParameters& border, std::size_t session);

/// A coefficient for all sessions that acts on every row alike: shape 1, of a channel that acts on
/// drives or readings.
[[nodiscard]] EffectPattern plain_effect(Channel channel,
                                         const std::vector<DrivenRecording>& recordings,
                                         const Robot& robot);

}  // namespace trussmap::estimation
