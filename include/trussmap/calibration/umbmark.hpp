// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// UMBmark: a square driven several times in both senses, a tape measure, and two factors.
//
//        ccw            start at (0, 0), heading +x; error = absolute - calculated, in these axes
//     +--<--+           L      side, m                 b   wheelbase the robot calculates with, m
//     v     ^           alpha  what a quarter turn lacks, rad; > 0: wheels farther apart than b
//     o-->--+           beta   turn over one leg to the left, rad; > 0: right wheel larger
//
// Borenstein & Feng (1996), for small angles (their 4.10a, 4.20, 4.22, 4.24 repaired):
//   cw centre (-2L(alpha + beta), -2L(alpha + beta)),  ccw centre (-2L(alpha - beta), 2L(alpha -
//   beta)) alpha = mean of (x_cw + x_ccw), (y_cw - y_ccw), over -4L beta  = mean of (x_cw - x_ccw),
//   (y_cw + y_ccw), over -4L E_d = (L + b sin(beta/2)) / (L - b sin(beta/2)),  E_b = (pi/2) / (pi/2
//   - alpha)
// Chong & Kleeman (1997) print pi/(pi - alpha) for E_b, which removes half of the error.
//
// The formulas drop second-order terms: at E_d = 1.005 and E_b = 1.01 some 2 % of the error is left
// for a second round. solve_square() fits E_d and E_b to the exact kinematics, by least squares on
// the four coordinates of the centres, and needs no second round on that account.
// Standard errors follow from the scatter of the runs; no scatter law is assumed.
#pragma once

#include "trussmap/calibration/estimate.hpp"
#include "trussmap/calibration/geometry_errors.hpp"

#include <vector>

namespace trussmap {

/// End errors (absolute - calculated), m, in the frame of the start.
struct SquareRuns {
  std::vector<Eigen::Vector2d> cw;
  std::vector<Eigen::Vector2d> ccw;
};

struct SquareSetup {
  double side = 4.0;        ///< m
  double wheelbase = 0.34;  ///< m, that the robot calculated with
};

/// What the runs say before any model of the robot.
struct SquareClusters {
  SampleMean cw;            ///< centre of gravity, m
  SampleMean ccw;           ///< m
  Estimate largest_offset;  ///< E_max,syst: distance of the farther centre from 0, m
  double sem = 0.0;  ///< standard error of a centre's coordinate (mean square of the four), m
  /// E_max,syst exceeds three standard errors: correcting it again can be seen to help.
  bool second_round_worthwhile = false;
};

struct SquareSolution {
  Estimate alpha;            ///< rad
  Estimate beta;             ///< rad
  Estimate diameter_ratio;   ///< E_d
  Estimate wheelbase_ratio;  ///< E_b
  Estimate left_factor;      ///< c_L
  Estimate right_factor;     ///< c_R
  Estimate wheelbase;        ///< corrected, m

  [[nodiscard]] GeometryErrors errors() const {
    return {diameter_ratio.value, wheelbase_ratio.value};
  }
};

/// alpha and beta from x alone and from y alone: they agree where E_d and E_b are all there is.
struct SquareAngles {
  Estimate alpha_x, alpha_y;  ///< rad
  Estimate beta_x, beta_y;    ///< rad
};

/// Throws std::invalid_argument on fewer than two runs in a direction.
[[nodiscard]] SquareClusters square_clusters(const SquareRuns& runs);

[[nodiscard]] SquareAngles square_angles(const SquareClusters& clusters, double side);

/// The papers' formulas. Throws SolveError where they have no answer (a turn of 90 degrees or more
/// missing, or a wheel ratio of 0).
[[nodiscard]] SquareSolution umbmark(const SquareClusters& clusters, const SquareSetup& setup);

/// E_d and E_b by Gauss-Newton on the exact kinematics. Throws SolveError where that does not
/// converge: errors as large as the square.
[[nodiscard]] SquareSolution solve_square(const SquareClusters& clusters, const SquareSetup& setup);

}  // namespace trussmap
