// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidate_gram.hpp"

#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr Eigen::Index kMostNumbers = 25'000'000;  // in columns
constexpr double kLeastColumnMode = 1e-6;          // of the columns' correlation

/// What makes these columns orthonormal, shapes x columns: zero columns and those that are sums of
/// the others go.
Eigen::MatrixXd orthonormalising(const Eigen::MatrixXd& M) {
  const Eigen::MatrixXd S = M.transpose() * M;
  const Eigen::ArrayXd sd = S.diagonal().array().max(0.0).sqrt();
  const Eigen::ArrayXd scale = (sd > 0.0).select(1.0 / sd, 0.0);
  const linalg::SymmetricModes modes =
      linalg::symmetric_modes(scale.matrix().asDiagonal() * S * scale.matrix().asDiagonal());
  Eigen::MatrixXd W(M.cols(), M.cols());
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < M.cols(); ++k) {
    const double mode = modes.eigenvalues[k];
    if (mode <= kLeastColumnMode) continue;
    W.col(kept++) = scale.matrix().asDiagonal() * modes.eigenvectors.col(k) / std::sqrt(mode);
  }
  return W.leftCols(kept);
}

}  // namespace

void GramBuilder::add(std::size_t candidate, const Effect& effect, const Score& score) {
  if (score.dof == 0) return;
  ColumnBlock block;
  block.candidate = candidate;
  block.first = count_;
  block.weights = orthonormalising(score.projected);
  block.size = block.weights.cols();
  if (block.size == 0 || block.size > kMostColumnsOfOne) return;
  if ((count_ + block.size) * rows_ > kMostNumbers) return;
  block.in_priors = Eigen::VectorXd::Zero(score.projected.cols());
  if (!effect.is_constant()) {
    const double prior_sd = facts_of(effect.channel).prior_sd;
    for (Eigen::Index k = 0; k < block.in_priors.size(); ++k) {
      block.in_priors[k] = score.largest[static_cast<std::size_t>(k)] / prior_sd;
    }
  }
  columns_.emplace_back(score.projected * block.weights);
  count_ += block.size;
  blocks_.push_back(std::move(block));
}

CandidateGram GramBuilder::gram(const Eigen::VectorXd& residuals) const {
  Eigen::MatrixXd X(rows_, count_);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    X.middleCols(blocks_[k].first, blocks_[k].size) = columns_[k];
  }
  CandidateGram result;
  result.blocks = blocks_;
  result.g = X.transpose() * residuals;
  result.G = Eigen::MatrixXd::Zero(count_, count_);
  result.G.selfadjointView<Eigen::Lower>().rankUpdate(X.transpose());
  result.G.triangularView<Eigen::StrictlyUpper>() = result.G.transpose();
  return result;
}

}  // namespace trussmap::criticism
