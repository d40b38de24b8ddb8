// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/steering_patterns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace trussmap::effects {

using drive::RowMotion;

DrivePattern more_of(const WheelColumn& column, std::size_t row, double reading) {
  const std::array<double, 3>& by = column.by_reading[row];
  return {.advance = by[0] * reading, .slip = by[1] * reading, .turn = by[2] * reading};
}

DrivePattern more_steering_pattern(double offset, double gain, const RowMotion& row) {
  if (row.wheels == nullptr) return {};
  for (const WheelColumn& column : *row.wheels) {
    if (column.steers) return more_of(column, row.row, offset + gain * column.reading[row.row]);
  }
  return {};
}

DrivePattern measured_left_pattern(double g, const RowMotion& row) {
  if (row.wheels == nullptr) return {};
  const WheelColumn& travel = row.wheels->front();
  const auto [ahead, aside, turn] = travel.by_reading[row.row];
  const double more = g * travel.reading[row.row] * turn;
  return {.advance = more * ahead, .turn = more * turn};
}

DrivePattern steered_left_pattern(double g, const RowMotion& row) {
  if (row.wheels == nullptr) return {};
  const WheelColumn& travel = row.wheels->front();
  const auto [ahead, aside, turn] = travel.by_reading[row.row];
  const double more = g * travel.reading[row.row] * turn;
  if (row.front) return {.advance = more};
  return {.advance = -more * (ahead - 1.0), .turn = -more * turn};
}

DrivePattern other_axle_pattern(double g, const RowMotion& row) {
  constexpr double kLeastShare = 0.1;  // of the steered wheel's way in the rear one's
  if (row.wheels == nullptr) return {};
  const WheelColumn& travel = row.wheels->front();
  const auto [ahead, aside, turn] = travel.by_reading[row.row];
  const double ratio =
      row.front ? 1.0 / std::max(ahead, kLeastShare) : 1.0 / std::hypot(1.0, row.length * turn);
  return more_of(travel, row.row, g * (ratio - 1.0) * travel.reading[row.row]);
}

}  // namespace trussmap::effects
