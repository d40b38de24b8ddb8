// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/place_uncertainty.hpp"

#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr double kStep = 0.125;  // of the search's: rows have to change sides of an edge

Eigen::VectorXd trace(const ScoreTest& tests, const Candidate& at,
                      const Eigen::VectorXd& coefficients) {
  return tests.columns(at.effect) * coefficients;
}

}  // namespace

std::vector<double> widening(const ScoreTest& tests, const Candidate& found,
                             const std::vector<double>& coefficients,
                             const Eigen::MatrixXd& others) {
  std::vector<double> result(coefficients.size(), 1.0);
  const auto count = static_cast<Eigen::Index>(coefficients.size());
  const auto parameters = static_cast<Eigen::Index>(found.parameters.size());
  if (parameters == 0 || count == 0) return result;
  const Eigen::Map<const Eigen::VectorXd> a(coefficients.data(), count);
  const Eigen::MatrixXd own = tests.columns(found.effect);
  if (own.cols() != count) return result;  // one set per session: such have no parameters
  Eigen::MatrixXd all(own.rows(), count + parameters);
  all.leftCols(count) = own;
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(count + parameters);
  std::vector<double> values;
  for (const ShapeParameter& one : found.parameters) values.push_back(one.value);
  for (Eigen::Index k = 0; k < parameters; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const SearchRange& range = found.search[place];
    std::vector<double> up = values;
    std::vector<double> down = values;
    up[place] = std::min(values[place] + kStep * range.step, range.most);
    down[place] = std::max(values[place] - kStep * range.step, range.least);
    const double apart = up[place] - down[place];
    if (apart <= 0.0) {
      all.col(count + k).setZero();
      prior[count + k] = 1.0;
      continue;
    }
    all.col(count + k) = (trace(tests, with_parameters(found, up), a) -
                          trace(tests, with_parameters(found, down), a)) /
                         apart;
    prior[count + k] = tests.dispersion() / std::pow(range.most - range.least, 2);
  }
  Eigen::MatrixXd left = tests.free_of_map(all);
  if (others.cols() > 0) {
    const Eigen::MatrixXd basis = linalg::orthonormal_basis(others);
    left -= (basis * (basis.transpose() * left)).eval();
  }
  Eigen::MatrixXd information = left.transpose() * left;
  const Eigen::MatrixXd known =
      linalg::DenseLdlt(information.topLeftCorner(count, count)).inverse();
  information.diagonal() += prior;
  const Eigen::MatrixXd joint = linalg::DenseLdlt(information).inverse();
  for (Eigen::Index k = 0; k < count; ++k) {
    const double factor = std::sqrt(joint(k, k) / known(k, k));
    if (std::isfinite(factor)) result[static_cast<std::size_t>(k)] = std::max(1.0, factor);
  }
  return result;
}

void widen_for_places(ModelFit& fit, const std::vector<Candidate>& found) {
  const auto sought = [](const Candidate& one) { return !one.parameters.empty(); };
  if (std::none_of(found.begin(), found.end(), sought)) return;
  const ScoreTest tests(*fit.state);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!sought(found[k])) continue;
    Eigen::MatrixXd others(tests.system().rows(), 0);
    for (std::size_t other = 0; other < found.size(); ++other) {
      if (other == k) continue;
      linalg::append_columns(others, tests.free_of_map(tests.columns(fit.model.effects[other])));
    }
    EffectEstimate& estimate = fit.effects[k];
    const std::vector<double> factors =
        widening(tests, found[k], estimate.effect.coefficients, others);
    for (std::size_t c = 0; c < factors.size(); ++c) estimate.sd[c] *= factors[c];
  }
}

}  // namespace trussmap::criticism
