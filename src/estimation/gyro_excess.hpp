// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a gyro and the wheels say of each other over a segment, beside the motion that both give
// (odometry/wheels_and_gyro.hpp).
//
//   e_k   excess of row k: the gyro's turn less the wheels', N(0, v_k) where neither errs
//
// Every row says something, and says it of no pose: of wheels and gyro alone. Of a segment four
// numbers are kept, sums of weights_k e_k that are as exact as one row each: the parts of e/sd(e)
// along an orthonormal basis of
//
//   duration at rest;  duration, path and turn while moving
//
// so nothing is lost of a constant bias (at rest and on the way), a scale of the gyro or of the
// wheels' turn, or wheels of different size. Path and turn are those of wheels and gyro together,
// whose noise does not correlate with the excess.
#pragma once

#include "estimation/segment_motion.hpp"

#include <vector>

namespace trussmap::estimation {

struct GyroExcess {
  int rows = 0;                     ///< numbers, 0 to 4
  Vector4 value = Vector4::Zero();  ///< whitened: each has variance 1
  std::vector<Vector4> weights;     ///< per row of the segment, 1/rad
};

/// Without readings, 0 numbers and no weights.
[[nodiscard]] GyroExcess gyro_excess(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                                     const Robot& robot, const Noise& noise);

/// What one unit of each pattern adds to the numbers, 4 x patterns; `patterns` as in
/// segment_motion.
[[nodiscard]] Eigen::Matrix<double, 4, Eigen::Dynamic> excess_slopes(
    const std::vector<SegmentRow>& rows, const std::vector<Vector4>& weights,
    const std::vector<const std::vector<effects::DrivePattern>*>& patterns);

}  // namespace trussmap::estimation
