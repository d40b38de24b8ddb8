// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tails and quantiles of the usual distributions. A p-value is an upper tail.
#pragma once

namespace trussmap::statistics {

/// Of chi^2; 1 for no degrees of freedom.
[[nodiscard]] double chi2_p_value(double chi2, int dof);
/// The same for degrees of freedom that are no whole number, such as Satterthwaite's.
[[nodiscard]] double chi2_p_value_real(double chi2, double dof);
/// Natural logarithm of chi2_p_value, also where that is too small for a number.
[[nodiscard]] double log_chi2_p_value(double chi2, int dof);
[[nodiscard]] double chi2_cdf(double chi2, double dof);
/// The upper tail of chi^2 with a noncentrality.
[[nodiscard]] double noncentral_chi2_tail(double chi2, double dof, double noncentrality);
/// The chi^2 that is exceeded with probability 1 - p.
[[nodiscard]] double chi2_quantile(double p, double dof);

[[nodiscard]] double normal_p_value(double z);
[[nodiscard]] double normal_quantile(double p);

[[nodiscard]] double student_p_value(double t, double dof);
[[nodiscard]] double student_quantile(double p, double dof);

/// Of a count as far from its mean on either side: at most twice the smaller tail.
[[nodiscard]] double binomial_p_value(int count, int trials, double probability);

[[nodiscard]] double fisher_p_value(double F, double dof_above, double dof_below);

}  // namespace trussmap::statistics
