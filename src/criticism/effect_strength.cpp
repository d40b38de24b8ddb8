// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/effect_strength.hpp"

#include "fit/fit_state.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <vector>

namespace trussmap::criticism {
namespace {

/// Of all measurements: which are laid goes with how the robot is believed to move.
double rows_of(const ModelFit& fit) {
  double rows = 0.0;
  for (const estimation::Measurement& one : fit.state->problem.measurements) rows += one.rows;
  return rows;
}

}  // namespace

double wald(const ModelFit& of, std::size_t effect) {
  const fitting::FitState& fit = *of.state;
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  std::vector<Eigen::Index> places;
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const fitting::Coefficient& one = fit.columns.coefficients[idx(unknown[k])];
    if (one.effect == effect) places.push_back(static_cast<Eigen::Index>(k));
  }
  if (places.empty()) return 0.0;
  const Eigen::MatrixXd C = fit.adjustment.coefficient_covariance(places, places);
  const Eigen::VectorXd a = fit.adjustment.coefficients(places);
  const double scatter = std::min(1.0, of.chi2 / std::max(1, of.dof));
  return a.dot(linalg::DenseLdlt(C).solve(a)) / scatter;
}

double chi2_of_all(const ModelFit& fit) {
  return fit.chi2 + fit.options.gate.value_or(0.0) * static_cast<double>(fit.left_out.size());
}

double scatter_left(const ModelFit& fit) {
  return std::max(1.0, fit.chi2 / std::max(1, fit.dof));
}

bool does_as_well(const ModelFit& with_fewer, const ModelFit& fit, std::size_t fewer) {
  const double more = chi2_of_all(with_fewer) - chi2_of_all(fit);
  const double expected = rows_of(with_fewer) - rows_of(fit);
  return more - expected * scatter_left(fit) <
         static_cast<double>(fewer) * kWorthKeeping * scatter_left(fit);
}

}  // namespace trussmap::criticism
