// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A step of Levenberg and Marquardt by normal equations: (A + m D) d = -g, D the diagonal of A.
#pragma once

#include "linalg/block_system.hpp"

namespace trussmap::linalg {

/// Factorises A + damping D; A stays as it is. An entry of D counts as at least `least` of its
/// largest: what has no stiffness at all cannot be damped by a share of it. Throws
/// NotPositiveDefinite.
void factorise_damped(BlockSystem& A, double damping, double least = 0.0);

/// What the quadratic model says that a step so damped takes off chi^2, g half its gradient.
[[nodiscard]] double predicted_decrease(const Eigen::VectorXd& step,
                                        const Eigen::VectorXd& gradient,
                                        const Eigen::VectorXd& diagonal, double damping);

inline constexpr double kRounding = 1e-15;  ///< relative: a few units in the last place

/// Whether a step is nothing but rounding of unknowns of that size.
[[nodiscard]] bool is_rounding(const Eigen::VectorXd& step, double size);

}  // namespace trussmap::linalg
