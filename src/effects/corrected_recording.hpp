// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A recording as it would be without the model's effects: what the wheels would have shown if the
// nominal model held.
//
// Wheel channels change the rows' travels, after steering has (steering.hpp), `gyro` and
// `gyro_scale` the yaw rates, `compass` the readings, `range`, `range_scale` and `bearing` the
// sightings. Other channels (creep of a drive that goes nowhere sideways, lever, lever_left, delay)
// have no place in a recording; the adjustment knows them.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::effects {

/// Throws std::invalid_argument where an effect has no shape.
void require_shapes(const Effect& effect);

/// g of one effect, row by row; 0 without coefficients. Throws std::invalid_argument where there
/// are too few for this session.
[[nodiscard]] std::vector<double> gains_of(const Effect& effect, const RowVariables& variables,
                                           int session, std::size_t rows);

/// Takes g, per row, of a recordable channel that acts on drives out of what wheels and gyro show.
void free_drive(Channel channel, const std::vector<double>& g, const Robot& robot,
                MotionRows& drive);

/// `variables` are this recording's. Throws std::invalid_argument, naming the effect: one of the
/// other channels, a shape that cannot be evaluated, coefficients that do not match. Effects
/// without coefficients count as 0; per session, those of `session` are taken.
[[nodiscard]] DrivenRecording corrected_recording(const DrivenRecording& recording,
                                                  const Model& model, const RowVariables& variables,
                                                  int session);

}  // namespace trussmap::effects
