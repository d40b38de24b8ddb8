// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/field_likelihood.hpp"

#include "linalg/dense.hpp"
#include "statistics/quadratic_forms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace trussmap::criticism {
namespace {

constexpr int kLengthsTried = 7;
constexpr int kSizesTried = 28;
constexpr double kLogSizesTried = 7.0;  // from the least to the largest
constexpr double kSeen = 1e-7;          // of the largest mode

/// L of a covariance that is definite but for rounding.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd covariance) {
  covariance.diagonal() *= 1.0 + 1e-9;
  return Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL();
}

double dispersion_over(double chi2, double dof) {
  return std::max(1.0, chi2 / std::max(1.0, dof));
}

/// -2 log likelihood of what has this dispersion.
double deviance_of(double chi2, double dof, double phi) {
  return dof * std::log(phi) + chi2 / phi;
}

double length_tried(const PlaceScores& scores, int k) {
  const double most = scores.grid.cell * std::max(scores.grid.columns, scores.grid.rows);
  const double least = std::min(2.0 * scores.grid.cell, 0.5 * most);
  return least * std::pow(most / least, k / (kLengthsTried - 1.0));
}

Eigen::MatrixXd covariance_over(const PlaceScores& scores, double length) {
  Eigen::MatrixXd R = matern_covariance(scores.grid, scores.nodes, length);
  R /= R.diagonal().mean();  // what a coarse grid has too little
  return R;
}

FieldModes modes_of(const ScoresBeside& one, const Eigen::MatrixXd& root) {
  const linalg::SymmetricModes modes = linalg::symmetric_modes(root.transpose() * one.G * root);
  FieldModes result;
  result.variances = modes.eigenvalues.cwiseMax(0.0);
  result.t = modes.eigenvectors.transpose() * (root.transpose() * one.s);
  result.fields = root * modes.eigenvectors;
  return result;
}

/// Of one length, all sizes from `least` on.
void add_sizes(const ScoresBeside& one, const FieldModes& modes, std::size_t length, double least,
               FieldLikelihood& all) {
  const double seen = kSeen * modes.variances.maxCoeff();
  std::vector<Eigen::Index> shown;
  for (Eigen::Index k = 0; k < modes.variances.size(); ++k) {
    if (modes.variances[k] > seen) shown.push_back(k);
  }
  const Eigen::ArrayXd d = modes.variances(shown);
  const Eigen::ArrayXd squares = modes.t(shown).array().square() / d;
  const double rest = std::max(0.0, one.chi2 - squares.sum());
  const double rest_dof = std::max(0.0, one.dof - static_cast<double>(d.size()));
  const double null = one.dispersion();
  const auto deviance = [&](double phi, double variance) {
    const Eigen::ArrayXd total = phi + variance * d;
    return (total.log() + squares / total).sum() + deviance_of(rest, rest_dof, phi);
  };
  for (int k = 0; k < kSizesTried; ++k) {
    FieldSize size;
    size.length = length;
    size.sigma = least * std::exp(kLogSizesTried * k / (kSizesTried - 1));
    const double variance = size.sigma * size.sigma;
    size.phi = null;  // of what this size leaves
    for (int round = 0; round < 20; ++round) {
      const Eigen::ArrayXd kept = size.phi / (size.phi + variance * d);
      size.phi = dispersion_over(rest + (squares * kept).sum(), rest_dof + kept.sum());
    }
    size.gain = deviance(null, 0.0) - deviance(size.phi, variance);
    all.sizes.push_back(size);
    if (size.gain > all.likeliest.gain) all.likeliest = size;
  }
}

}  // namespace

FieldPriors priors_over(const PlaceScores& scores) {
  FieldPriors priors;
  for (int k = 0; k < kLengthsTried; ++k) {
    priors.lengths.push_back(length_tried(scores, k));
    priors.roots.push_back(triangle_of(covariance_over(scores, priors.lengths.back())));
  }
  return priors;
}

Eigen::MatrixXd mean_covariance(const PlaceScores& scores) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(scores.count(), scores.count());
  for (const int k : {1, 3, 5}) sum += covariance_over(scores, length_tried(scores, k));
  return sum / 3.0;
}

void ScoresBeside::take_out(const Eigen::VectorXd& amounts) {
  const Eigen::VectorXd column = G * amounts;
  const double own = amounts.dot(column);
  if (!(own > 1e-9 * G.diagonal().maxCoeff() * amounts.squaredNorm())) return;
  const double score = amounts.dot(s);
  s -= column * (score / own);
  G -= column * column.transpose() / own;
  chi2 -= score * score / own;
  dof -= 1.0;
}

void ScoresBeside::take_out(const Eigen::MatrixXd& amounts, double stiffness) {
  const Eigen::MatrixXd columns = G * amounts;
  Eigen::MatrixXd own = amounts.transpose() * columns;
  const double trace = own.trace();
  own.diagonal().array() += stiffness;
  const linalg::DenseCholesky factor(own);
  const Eigen::MatrixXd solved = factor.solve(columns.transpose());
  const Eigen::VectorXd score = amounts.transpose() * s;
  const Eigen::VectorXd value = factor.solve(Eigen::MatrixXd(score));
  s -= columns * value;
  G -= columns * solved;
  chi2 -= score.dot(value);
  dof -= trace > 0.0 ? static_cast<double>(amounts.cols()) - stiffness * factor.inverse().trace()
                     : 0.0;
}

ScoresBeside ScoresBeside::part(Eigen::Index first, Eigen::Index count) const {
  return {G.block(first, first, count, count), s.segment(first, count), chi2, dof};
}

double ScoresBeside::dispersion() const {
  return dispersion_over(chi2, dof);
}

double ScoresBeside::deviance() const {
  return deviance_of(chi2, dof, dispersion());
}

FieldLikelihood likelihood_of(const ScoresBeside& one, const FieldPriors& priors) {
  FieldLikelihood result;
  double largest = 0.0;
  for (const Eigen::MatrixXd& root : priors.roots) {
    result.modes.push_back(modes_of(one, root));
    largest = std::max(largest, result.modes.back().variances.maxCoeff());
  }
  if (!(largest > 0.0)) return result;
  const double least = 0.1 / std::sqrt(largest);
  result.likeliest.phi = one.dispersion();
  for (std::size_t k = 0; k < result.modes.size(); ++k) {
    add_sizes(one, result.modes[k], k, least, result);
  }
  return result;
}

double FieldForm::chance(double phi) const {
  return statistics::quadratic_form_p_value(value / phi, weights);
}

FieldForm form_of(const ScoresBeside& one, const Eigen::MatrixXd& R) {
  const Eigen::MatrixXd root = triangle_of(R);
  const Eigen::VectorXd weights =
      linalg::symmetric_modes(root.transpose() * one.G * root).eigenvalues;
  return {one.s.dot(R * one.s), {weights.begin(), weights.end()}};
}

bool may_be_there(const ScoresBeside& one, const Eigen::MatrixXd& R) {
  // Of all such forms the 0.99 quantile is least, 2.33, where they are normal.
  constexpr double kLeastSds = 2.3;
  const Eigen::MatrixXd GR = one.G * R;
  const double sd = std::sqrt(2.0 * GR.cwiseProduct(GR.transpose()).sum());
  return one.s.dot(R * one.s) > GR.trace() + kLeastSds * sd;
}

}  // namespace trussmap::criticism
