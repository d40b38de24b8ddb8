// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace trussmap::statistics {
namespace {

template <typename Distribution>
double upper_tail(const Distribution& distribution, double value) {
  return boost::math::cdf(boost::math::complement(distribution, value));
}

}  // namespace

double chi2_p_value(double chi2, int dof) {
  return dof <= 0 ? 1.0 : upper_tail(boost::math::chi_squared(dof), chi2);
}

double chi2_p_value_real(double chi2, double dof) {
  return boost::math::gamma_q(0.5 * dof, 0.5 * chi2);
}

double log_chi2_p_value(double chi2, int dof) {
  if (dof == 0) return 0.0;
  const double p = chi2_p_value(chi2, dof);
  if (p > 1e-280) return std::log(p);
  return -0.5 * chi2 + (0.5 * dof - 1.0) * std::log(0.5 * chi2) - std::lgamma(0.5 * dof);
}

double chi2_cdf(double chi2, double dof) {
  return boost::math::cdf(boost::math::chi_squared(dof), chi2);
}

double noncentral_chi2_tail(double chi2, double dof, double noncentrality) {
  if (!(noncentrality > 0.0)) return chi2_p_value_real(chi2, dof);
  return upper_tail(boost::math::non_central_chi_squared(dof, noncentrality), chi2);
}

double chi2_quantile(double p, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), p);
}

double normal_p_value(double z) {
  return upper_tail(boost::math::normal(), z);
}

double normal_quantile(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

double student_p_value(double t, double dof) {
  return upper_tail(boost::math::students_t(dof), t);
}

double student_quantile(double p, double dof) {
  return boost::math::quantile(boost::math::students_t(dof), p);
}

double binomial_p_value(int count, int trials, double probability) {
  const boost::math::binomial distribution(trials, probability);
  const double low = boost::math::cdf(distribution, count);
  const double high = count == 0 ? 1.0 : upper_tail(distribution, count - 1);
  return std::min(1.0, 2.0 * std::min(low, high));
}

double fisher_p_value(double F, double dof_above, double dof_below) {
  return upper_tail(boost::math::fisher_f(dof_above, dof_below), F);
}

}  // namespace trussmap::statistics
