// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// p-values of several tests together: with adjusted ones the chance that any right hypothesis falls
// below a level is that level at most.
#pragma once

#include <cstddef>
#include <vector>

namespace trussmap::statistics {

/// A p-value that is the least of so many, or one of them: min(1, tests p).
[[nodiscard]] double bonferroni(double p_value, double tests);

/// Holm (1979): the k-th smallest of n times n - k + 1, and no smaller than those before it. Order
/// kept.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p_values);
/// The same where each stands for the best of so many tests, of which there are `all`: other tests,
/// that have no p-value here, count as well.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p_values,
                                       const std::vector<int>& tests, double all);

}  // namespace trussmap::statistics
