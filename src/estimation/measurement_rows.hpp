// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far a measurement is from what the unknowns say, and the derivatives of that.
//
//   e         predicted - measured, rows as in recording_problem.hpp; angles wrapped    m, rad
//   p, theta  robot pose; q = p + R(theta) (ahead, left) its sensor; l a landmark
//   delta     l - q
//
//   segment      R(theta_i)'(p_j - p_i) - d,  theta_j - theta_i - a,  theta_i - m
//   gyro       -value: nothing is predicted of an excess
//   standing   R(theta)' delta - offset
//   view       |delta| - range,  direction(delta) - theta - bearing
//   direction  direction(delta) - theta - bearing
//   cartesian_view  R(theta)' delta - offset
//   sighting_yaw    phi - theta - yaw, phi the landmark's orientation
//   survey     l - s
//   survey_heading  phi - h
//   truth      q - t,  theta - h
//   fix        p + R(theta + heading) (ahead, left) + (x, y) - f      (x, y and heading of the
//   view) loop       R(theta_i)'(p_j - p_i) - d,  theta_j - theta_i - a
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

namespace trussmap {

using RowsByNode = Eigen::Matrix<double, 4, 3>;  ///< unused rows and columns are zero

struct MeasurementRows {
  Vector4 error = Vector4::Zero();
  RowsByNode by_from = RowsByNode::Zero();
  RowsByNode by_to = RowsByNode::Zero();
  ByView by_view = ByView::Zero();
};

/// An effect's pattern for one sighting, truth row or fix; nullptr where it has none.
[[nodiscard]] const ViewPattern* unit_view_of(const EffectPattern& effect,
                                              const Measurement& measurement);

/// The sum of the effects' patterns for one sighting, truth row or fix; `offsets` are all
/// coefficients of the border less their references.
[[nodiscard]] ViewPattern view_of(const EffectParameters& border, const Eigen::VectorXd& offsets,
                                  const Measurement& measurement);

/// `motion` is a segment's four numbers (with effects), `view` the sum of the effects' patterns.
[[nodiscard]] MeasurementRows measurement_rows(const RecordingProblem& problem,
                                               const Measurement& measurement,
                                               const RecordingState& state, const Vector4& value,
                                               const ViewPattern& view);

}  // namespace trussmap
