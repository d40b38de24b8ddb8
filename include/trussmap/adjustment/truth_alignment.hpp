// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How the truth sits on the drive: where on the robot it tracks, where it believes ahead to be, and
// how its clock runs. Nobody measures these, yet each of them looks like wheel errors.
//
//   ahead, left   the tracked point, from the axle's centre      m, robot axes     all recordings
//   heading       truth's heading less the robot's               rad               all recordings
//   late          truth rows are stamped late by this at the     s                 each recording
//                 recording's start,
//   clock         and by so much more per second                 s/s               each recording
//
// A late row shows the robot where it was: g late is g times the speed behind and g times the turn
// rate back. That is exact while both are steady, so rates are those of a moment about the row.
#pragma once

#include "trussmap/adjustment/effect_border.hpp"

namespace trussmap {

/// Coefficients of all that, in this order, late and clock by turns. Weak priors keep what a
/// motion does not show near 0. None where no recording has truth.
[[nodiscard]] EffectBorder truth_alignment(const std::vector<Recording>& recordings,
                                           const Robot& robot);

}  // namespace trussmap
