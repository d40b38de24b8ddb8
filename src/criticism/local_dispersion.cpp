// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/local_dispersion.hpp"

#include "fit/fit_projection.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr double kChance = 0.001;
constexpr double kDoubt = 0.05;  // that it is larger still

}  // namespace

LocalDispersion::LocalDispersion(const fitting::FitState& fit, const ScoreTest& tests)
    : tests_(tests) {
  const fitting::FitProjection P(fit, fit.problem, tests.system(), tests.present(),
                                 tests.fitted_rows());
  own_.reserve(fit.problem.measurements.size());
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    own_.push_back(P.left_out(k) ? Eigen::MatrixXd::Zero(fit.problem.measurements[k].rows,
                                                         fit.problem.measurements[k].rows)
                                 : P.own_block(k));
  }
}

double LocalDispersion::operator()(const Score& score) const {
  const Eigen::VectorXd u =
      score.projected *
      Eigen::Map<const Eigen::VectorXd>(score.coefficients.data(),
                                        static_cast<Eigen::Index>(score.coefficients.size()));
  const double all = u.squaredNorm();
  if (!(all > 0.0)) return 1.0;
  double x2 = 0.0;
  double v1 = 0.0;
  double v2 = 0.0;
  for (std::size_t k = 0; k < own_.size(); ++k) {
    const auto here = u.segment(tests_.system().first_row(k), own_[k].rows());
    const double own = here.squaredNorm();
    const double v = here.dot(own_[k] * here) - own * own / all;
    if (!(v > 0.0)) continue;
    const double x =
        here.dot(tests_.residuals().segment(tests_.system().first_row(k), own_[k].rows())) + own;
    x2 += x * x;
    v1 += v;
    v2 += v * v;
  }
  if (!(v1 > 0.0)) return 1.0;
  const double lambda = x2 / v1;
  const double n = v1 * v1 / v2;
  const double above = statistics::chi2_p_value_real(n * lambda, n);
  if (above < kChance) return lambda;
  // Noise that is stated too large: what it is at most.
  if (1.0 - above < kChance)
    return std::min(1.0, n * lambda / statistics::chi2_quantile(kDoubt, n));
  return 1.0;
}

}  // namespace trussmap::criticism
