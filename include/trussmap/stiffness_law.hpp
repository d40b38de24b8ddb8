// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How stiff a bar is, given how unsure its route is.
//
//   C       covariance of one traversal of the route (mean over traversals), map axes   m^2
//   theta   orientation of the bar                                                      rad
//   t       number of traversals
//   C'      R(theta)' C R(theta): x' along the bar, y' across it                        m^2
//
// printed          B = R diag(t/dx, t/dy) R',  dx = sqrt(2/pi C'_11), dy = sqrt(2/pi C'_22)
//                  Golfarelli, Maio & Rizzi (1998), section 3.1: stiffness = 1/mean error.
//                  C'_12 is dropped.                                                    1/m
// gauss_markov     B = t C^-1, off-diagonal kept: stiffness = 1/variance, the weights of least
//                  squares; strain energy is then half of chi squared.                  1/m^2
//
// A law is a small value: pass it where bars are made.
#pragma once

#include "trussmap/planar.hpp"

namespace trussmap {

enum class StiffnessLaw { printed, gauss_markov };

/// 2x2 stiffness of a bar in map axes. Throws std::invalid_argument unless C is positive definite
/// (for `printed`: positive along and across the bar) and t > 0.
[[nodiscard]] Matrix2 bar_stiffness(StiffnessLaw law, const Matrix2& covariance, double orientation,
                                    double traversals);

}  // namespace trussmap
