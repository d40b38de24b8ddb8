// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "estimation/measurement.hpp"

namespace trussmap::estimation {

/// Of a way from pose to pose in the axes of its start: displacement and turn, not wrapped.
///   R(theta_i)'(p_j - p_i) - d,  theta_j - theta_i - a
[[nodiscard]] inline MeasurementRows way_rows(const Pose& from, const Pose& to,
                                              const Vector4& value) {
  MeasurementRows rows;
  const Matrix2 R = rotation(-from.heading);
  const Vector2 seen = R * (to.position() - from.position());
  rows.error.head<2>() = seen - value.head<2>();
  rows.error[2] = to.heading - from.heading - value[2];
  rows.by_from.topLeftCorner<2, 2>() = -R;
  rows.by_from.block<2, 1>(0, 2) = -quarter_turn(seen);
  rows.by_from(2, 2) = -1.0;
  rows.by_to.topLeftCorner<2, 2>() = R;
  rows.by_to(2, 2) = 1.0;
  return rows;
}

}  // namespace trussmap::estimation
