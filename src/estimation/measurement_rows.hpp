// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far a measurement is from what the unknowns say, and the derivatives of that: predicted less
// measured, angles wrapped, by its kind (kinds/), with what effects add.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

namespace trussmap::estimation {

/// An effect's pattern for one sighting, truth row, fix or loop; nullptr where it has none.
[[nodiscard]] const effects::ViewPattern* unit_view_of(const EffectPattern& effect,
                                                       const Measurement& measurement);

/// Where its sensor is stated to sit, and the sum of the effects' patterns for one sighting, truth
/// row, fix or loop; `offsets` are all coefficients of the border less their references.
[[nodiscard]] effects::ViewPattern view_of(const EffectParameters& border,
                                           const Eigen::VectorXd& offsets,
                                           const Measurement& measurement);

/// The same for a row of a session's stream, whose sensor is `mounted` there (mounted_views.hpp).
[[nodiscard]] effects::ViewPattern view_of(const EffectParameters& border,
                                           const Eigen::VectorXd& offsets, RecordingStream stream,
                                           std::size_t session, std::size_t row,
                                           const effects::ViewPattern& mounted);

/// Values of what a measurement lies between.
[[nodiscard]] Ends ends_of(const RecordingProblem& problem, const Measurement& measurement,
                           const RecordingState& state);

/// `value` is a segment's four numbers (with effects), `view` the sum of the effects' patterns.
[[nodiscard]] MeasurementRows measurement_rows(const RecordingProblem& problem,
                                               const Measurement& measurement,
                                               const RecordingState& state, const Vector4& value,
                                               const effects::ViewPattern& view);

}  // namespace trussmap::estimation
