// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What errors of a steered drive add to a row, to first order (exactly: effects/steering.hpp).
#pragma once

#include "drive/row_motion.hpp"
#include "effects/channel_physics.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>

namespace trussmap::effects {

/// What so much more of one column's reading adds.
[[nodiscard]] DrivePattern more_of(const WheelColumn& column, std::size_t row, double reading);

/// What a steering angle adds that is this [rad] larger, and by this share of itself.
[[nodiscard]] DrivePattern more_steering_pattern(double offset, double gain,
                                                 const drive::RowMotion& row);
/// What a measured wheel g further to the left adds (drive/steered_motion.hpp), by its derivative.
[[nodiscard]] DrivePattern measured_left_pattern(double g, const drive::RowMotion& row);
/// The same of the wheel whose angle is read.
[[nodiscard]] DrivePattern steered_left_pattern(double g, const drive::RowMotion& row);
/// What a share g of the difference adds between the travel of a rear and of the steered wheel.
[[nodiscard]] DrivePattern other_axle_pattern(double g, const drive::RowMotion& row);

}  // namespace trussmap::effects
