// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/score_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace trussmap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBatchBytes = 100e6;  // of row patterns at a time

}  // namespace

ScoreTest::ScoreTest(const ModelFit& fit)
    : fit_(fit),
      context_(fit.recordings, fit.model.robot, fit.paths),
      system_(std::make_unique<RecordingSystem>(fit.problem, fit.columns.border)) {
  std::vector<double> weights(fit.problem.measurements.size(), 1.0);
  for (const int k : fit.adjustment.left_out) weights[idx(k)] = 0.0;
  system_->set_weights(weights);
  system_->linearise(fit.adjustment.state, fit.adjustment.coefficients);
  system_->factorise();
  const Eigen::MatrixXd& M = system_->border();
  const Eigen::MatrixXd left =
      M - system_->times(system_->solve_nodes(system_->transposed_times(M)));
  if (left.cols() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(left);
    present_ = factor.householderQ() * Eigen::MatrixXd::Identity(left.rows(), factor.rank());
  } else {
    present_ = Eigen::MatrixXd(M.rows(), 0);
  }
  if (fit.adjustment.dof > 0) {
    dispersion_ = std::max(1.0, fit.adjustment.chi2 / fit.adjustment.dof);
  }
}

EffectColumns ScoreTest::columns(const Effect& effect) const {
  Effect fresh = effect;
  fresh.coefficients.clear();
  return effect_columns({fresh}, context_);
}

Eigen::MatrixXd ScoreTest::projected(const Eigen::MatrixXd& M) const {
  Eigen::MatrixXd left = M - system_->times(system_->solve_nodes(system_->transposed_times(M)));
  if (present_.cols() > 0) left -= present_ * (present_.transpose() * left);
  return left;
}

Score ScoreTest::score_of(const EffectColumns& columns, const Effect& effect,
                          const Eigen::MatrixXd& whole, const Eigen::MatrixXd& projected) const {
  const Eigen::Index count = projected.cols();
  const double plausible = facts_of(*parse_channel(effect.channel)).plausible;
  Score result;
  result.projected = projected;
  result.coefficients.assign(static_cast<std::size_t>(count), 0.0);
  result.sd.assign(static_cast<std::size_t>(count), kInfinity);
  result.smallest_detectable.assign(static_cast<std::size_t>(count), kInfinity);
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double largest = columns.coefficients[static_cast<std::size_t>(k)].largest;
    const double share =
        projected.col(k).squaredNorm() / std::max(whole.col(k).squaredNorm(), 1e-300);
    // What the data tell must not be less than what was believed before.
    const double uncertainty =
        largest * std::sqrt(dispersion_ / std::max(projected.col(k).squaredNorm(), 1e-300));
    if (largest > 0.0 && share > kLeastShare && uncertainty < kLargestUncertainty * plausible) {
      seen.push_back(k);
    } else {
      result.projected.col(k).setZero();
    }
  }
  const auto dof = static_cast<Eigen::Index>(seen.size());
  if (dof == 0) return result;
  Eigen::MatrixXd M(projected.rows(), dof);
  Eigen::VectorXd prior(dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const Eigen::Index column = seen[static_cast<std::size_t>(k)];
    M.col(k) = projected.col(column);
    const double largest = columns.coefficients[static_cast<std::size_t>(column)].largest;
    prior[k] = dispersion_ * largest * largest / (plausible * plausible);
  }
  const Eigen::MatrixXd S = M.transpose() * M;
  const Eigen::VectorXd g = M.transpose() * system_->residuals();
  Eigen::MatrixXd with_prior = S;
  with_prior.diagonal() += prior;
  const Eigen::LDLT<Eigen::MatrixXd> factor(with_prior);
  const Eigen::VectorXd estimate = -factor.solve(g);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(dof, dof));
  result.score = std::max(0.0, -g.dot(estimate));
  // Shapes that are nearly the same count once.
  const Eigen::VectorXd scale = with_prior.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scale.asDiagonal() * S *
                                                             scale.asDiagonal());
  for (Eigen::Index k = 0; k < dof; ++k) result.dof += modes.eigenvalues()[k] > 1e-6 ? 1 : 0;
  result.p_value = chi2_p_value(result.score, result.dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const auto place = static_cast<std::size_t>(seen[static_cast<std::size_t>(k)]);
    result.coefficients[place] = estimate[k];
    result.sd[place] = std::sqrt(std::max(0.0, covariance(k, k)));
    result.smallest_detectable[place] = std::sqrt(kDetectableScore / S(k, k));
  }
  return result;
}

std::vector<Score> ScoreTest::test(const std::vector<Effect>& candidates) const {
  std::size_t rows = 1;
  for (const Recording& recording : fit_.recordings) rows += recording.drive.rows();
  const auto batch = static_cast<std::size_t>(
      std::max(1.0, kBatchBytes / (static_cast<double>(rows) * sizeof(DrivePattern))));
  std::vector<Score> scores;
  scores.reserve(candidates.size());
  for (std::size_t first = 0; first < candidates.size();) {
    std::vector<EffectColumns> columns;
    EffectBorder border;
    std::size_t next = first;
    while (next < candidates.size() && (next == first || border.size() < batch)) {
      columns.push_back(this->columns(candidates[next]));
      for (EffectPattern& pattern : columns.back().border) border.push_back(std::move(pattern));
      ++next;
    }
    const Eigen::MatrixXd M =
        system_->columns_of(border, fit_.adjustment.state, fit_.adjustment.coefficients);
    const Eigen::MatrixXd left = projected(M);
    Eigen::Index at = 0;
    for (std::size_t k = first; k < next; ++k) {
      const EffectColumns& own = columns[k - first];
      const auto count = static_cast<Eigen::Index>(own.coefficients.size());
      scores.push_back(
          score_of(own, candidates[k], M.middleCols(at, count), left.middleCols(at, count)));
      at += count;
    }
    first = next;
  }
  return scores;
}

double ScoreTest::joint_score(const std::vector<Effect>& effects) const {
  Eigen::MatrixXd M(system_->rows(), 0);
  for (const Score& one : test(effects)) {
    const Eigen::Index before = M.cols();
    M.conservativeResize(Eigen::NoChange, before + one.projected.cols());
    M.rightCols(one.projected.cols()) = one.projected;
  }
  if (M.cols() == 0) return 0.0;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(M);
  return (M * factor.solve(residuals())).squaredNorm();
}

}  // namespace trussmap
