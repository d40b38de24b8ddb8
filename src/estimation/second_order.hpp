// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What Gauss and Newton leave out of the second derivatives of chi^2/2, one measurement at a time:
//
//   sum over rows i of  w_i d^2 e_i,    w = W'W e
//
// by the node `from` (3), the node `to` (3; of a landmark the first two, of an orientation the
// first) and the nine numbers of the view. Of ways in the axes of their start, where no number of
// the view is asked for, in closed form: with f = R w, v the way in map axes,
//
//   by theta twice                -f.v
//   by theta and the way's end    f turned by a quarter
//   by theta and its start        the opposite
//
// else by numerical derivatives of measurement_rows: central differences, whose error is about 1e-9
// of the value.
#pragma once

#include "estimation/measurement_rows.hpp"

#include <array>

namespace trussmap::estimation {

using SecondOrder = Eigen::Matrix<double, 15, 15>;
inline constexpr int kSecondOrderTo = 3;    ///< where `to` begins
inline constexpr int kSecondOrderView = 6;  ///< where the view begins

/// `weighted` is w. Moves the state's two nodes to and fro, and leaves them as they were. By the
/// view only where `with_view`; of what is driven the view has no part.
[[nodiscard]] SecondOrder second_order(const RecordingProblem& problem,
                                       const Measurement& measurement, RecordingState& state,
                                       const effects::ViewPattern& view, const Vector4& weighted,
                                       bool with_view);

/// Second derivatives of a segment's four numbers by the border's unknown coefficients, one matrix
/// each.
using SegmentBends = std::array<Eigen::MatrixXd, 4>;
[[nodiscard]] SegmentBends segment_bends(const RecordingProblem& problem,
                                         const Measurement& segment, const EffectParameters& border,
                                         const Eigen::VectorXd& offsets);

}  // namespace trussmap::estimation
