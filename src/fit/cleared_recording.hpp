// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings with the model's effects taken out, for methods that reckon and do not adjust.
//
//   drive       travels, turns and readings less what the effects add to them, row by row
//   sightings   ranges and bearings likewise; moved back by a delay (those that fall out of the
//               drive are dropped)
//
// What no column of a recording can say stands beside it: how far the robot slipped to its left in
// a row (creep), and where the point lies that meets landmarks and carries the sensors (lever).
//
// Effects act side by side on what was recorded, as in a fit (effect_columns.hpp), with the
// coefficients that the model states. Shapes that speak of heading, x or y see the path that is
// dead-reckoned from the cleared recording itself, which two passes give.
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::fitting {

struct ClearedRecording {
  DrivenRecording recording;    ///< truth and survey as they were
  std::vector<double> slip;     ///< per drive row, m to the robot's left; empty: none
  std::vector<Vector2> sensor;  ///< per sighting, m, robot frame
};

/// One per recording. Throws std::invalid_argument, naming the effect, where one cannot be applied.
[[nodiscard]] std::vector<ClearedRecording> cleared(const std::vector<DrivenRecording>& recordings,
                                                    const Model& model);

/// Its dead-reckoned path, from the first compass heading (else 0) at the origin.
[[nodiscard]] SessionPath reckoned_path(const ClearedRecording& one, const Model& model);

/// A fit's recordings, freed from its effects as it has them; truth at the fit's times.
[[nodiscard]] std::vector<ClearedRecording> cleared(const FitState& fit);

/// The same with other coefficients, as offsets_of gives them.
[[nodiscard]] std::vector<ClearedRecording> cleared(const FitState& fit,
                                                    const Eigen::VectorXd& offsets);

}  // namespace trussmap::fitting
