// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tails of what is quadratic in normal errors, and of the largest of many correlated ones.
#pragma once

#include <vector>

namespace trussmap::statistics {

/// How likely sum_k weight_k z_k^2 of independent standard normal z_k exceeds `value`, by
/// saddlepoint (Kuonen 1999, Biometrika 86), off by a tenth of itself at most. Weights below 0
/// count as 0; 1 where none is above.
[[nodiscard]] double quadratic_form_p_value(double value, const std::vector<double>& weights);

/// How likely at most, max_k z_k^2 exceeds `value`, where the z_k are standard normal and each has
/// the correlation cosines[k] with the next (Davies 1977, Biometrika 64: by the length of their
/// path on the sphere).
[[nodiscard]] double largest_square_p_value(double value, const std::vector<double>& cosines);

}  // namespace trussmap::statistics
