// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/data_snooping.hpp"

#include "estimation/fitted_rows.hpp"
#include "estimation/recording_system.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

namespace trussmap::estimation {
namespace {

constexpr double kUnchecked = 1e-6;
constexpr double kNoncentrality = 17.08;

/// r' R^-1 r over what is checked, and how many directions that are.
void test_against_others(const Eigen::VectorXd& r, const Eigen::MatrixXd& R,
                         CheckedMeasurement& result) {
  const linalg::SymmetricModes axes = linalg::symmetric_modes(R);
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    const double share = axes.eigenvalues[k];
    if (share < kUnchecked) continue;
    ++result.checked;
    result.statistic += std::pow(axes.eigenvectors.col(k).dot(r), 2) / share;
  }
  result.p_value = statistics::chi2_p_value(result.statistic, result.checked);
}

/// `rows` has the measurement at full weight.
CheckedMeasurement check(const FittedRows& fit, const RecordingSystem& rows, const Measurement& one,
                         std::size_t k, bool left_out) {
  CheckedMeasurement result;
  result.measurement = static_cast<int>(k);
  const Eigen::MatrixXd predicted = fit.covariance(rows, k);
  const Eigen::VectorXd r = rows.residuals().segment(rows.first_row(k), one.rows);
  const Eigen::MatrixXd one_all = Eigen::MatrixXd::Identity(one.rows, one.rows);
  // Of a measurement that had no part in the fit the prediction's spread adds to its own.
  const Eigen::MatrixXd R = one_all + (left_out ? 1.0 : -1.0) * predicted;
  test_against_others(r, R, result);
  const Eigen::MatrixXd unwhiten = one.whitener.topLeftCorner(one.rows, one.rows).inverse();
  for (Eigen::Index value = 0; value < one.rows; ++value) {
    const double share = R(value, value);
    result.redundancy += left_out ? 0.0 : share;
    if (share < kUnchecked) {
      result.minimal_detectable[value] = std::numeric_limits<double>::infinity();
      continue;
    }
    result.standardised[value] = r[value] / std::sqrt(share);
    const double sd = unwhiten.row(value).norm();
    result.minimal_detectable[value] =
        sd * std::sqrt(kNoncentrality * (left_out ? share : 1.0 / share));
  }
  return result;
}

}  // namespace

std::vector<CheckedMeasurement> snoop(const RecordingSystem& system, const FittedRows& fitted,
                                      const RecordingProblem& problem,
                                      const EffectParameters& border,
                                      const RecordingAdjustment& adjustment) {
  std::vector<bool> left_out(problem.measurements.size(), false);
  for (const int k : adjustment.left_out) left_out[idx(k)] = true;
  std::optional<RecordingSystem> whole;  // rows of what was left out, with their full weight
  if (!adjustment.left_out.empty()) {
    whole.emplace(problem, border);
    whole->linearise(adjustment.state, adjustment.coefficients);
  }
  std::vector<CheckedMeasurement> result;
  result.reserve(problem.measurements.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const RecordingSystem& rows = left_out[k] ? *whole : system;
    result.push_back(check(fitted, rows, problem.measurements[k], k, left_out[k]));
  }
  return result;
}

std::vector<CheckedMeasurement> snoop(const RecordingProblem& problem,
                                      const EffectParameters& border,
                                      const RecordingAdjustment& adjustment) {
  RecordingSystem system(problem, border);
  system.set_weights(weights_without(adjustment.left_out, problem.measurements.size()));
  system.linearise(adjustment.state, adjustment.coefficients);
  system.factorise();
  return snoop(system, FittedRows(system), problem, border, adjustment);
}

std::vector<OutlierTest> outliers(const std::vector<CheckedMeasurement>& checked, double level,
                                  double dispersion) {
  const auto count = static_cast<double>(checked.size());
  std::vector<OutlierTest> result;
  for (const CheckedMeasurement& one : checked) {
    const double statistic = one.statistic / dispersion;
    const double p =
        statistics::bonferroni(statistics::chi2_p_value(statistic, one.checked), count);
    if (p < level) result.push_back({one.measurement, one.checked, statistic, p});
  }
  std::stable_sort(result.begin(), result.end(), [](const OutlierTest& a, const OutlierTest& b) {
    return a.p_adjusted < b.p_adjusted ||
           (a.p_adjusted == b.p_adjusted && a.statistic > b.statistic);
  });
  return result;
}

}  // namespace trussmap::estimation
