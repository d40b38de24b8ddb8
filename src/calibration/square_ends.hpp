// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the square ends, driven both ways, and what that leaves of what was measured.
#pragma once

#include "trussmap/umbmark.hpp"

#include <Eigen/Core>

namespace trussmap::calibration {

struct SquareEnds {
  PathError cw;
  PathError ccw;

  /// Measured - modelled: cw x, y, ccw x, y, m.
  [[nodiscard]] Eigen::Vector4d left_of(const SquareClusters& clusters) const {
    Eigen::Vector4d left;
    left << clusters.cw.mean - cw.error.head<2>(), clusters.ccw.mean - ccw.error.head<2>();
    return left;
  }
  /// Of the modelled ones, by E_d and E_b.
  [[nodiscard]] Eigen::Matrix<double, 4, 2> jacobian() const {
    Eigen::Matrix<double, 4, 2> by_ratios;
    by_ratios << cw.jacobian.topRows<2>(), ccw.jacobian.topRows<2>();
    return by_ratios;
  }
};

[[nodiscard]] inline SquareEnds square_ends(const SquareSetup& setup,
                                            const GeometryErrors& errors) {
  return {path_error(square_path(setup.side, Direction::cw), setup.wheelbase, errors),
          path_error(square_path(setup.side, Direction::ccw), setup.wheelbase, errors)};
}

/// The errors of both solutions, by as much wider as the centres, or headings and positions,
/// contradict each other; nothing where they do not.
void widen_errors(SquareRound& round);

}  // namespace trussmap::calibration
