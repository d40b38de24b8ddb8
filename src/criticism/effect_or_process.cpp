// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/effect_or_process.hpp"

#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace trussmap::criticism {
namespace {

constexpr Eigen::Index kDraws = 4000;
constexpr std::uint64_t kSeed = 5;
constexpr double kLeastMode = 1e-10;  // of the largest
constexpr double kSmallest = 0.03;    // s of the largest mode
constexpr double kLargest = 1e6;
constexpr double kStep = 1.4;  // from one s to the next

/// 0, then from what is hardly seen to what swamps everything.
Eigen::VectorXd sizes_for(double largest_mode) {
  const auto steps =
      static_cast<Eigen::Index>(std::ceil(std::log(kLargest / kSmallest) / std::log(kStep)));
  Eigen::VectorXd sizes(steps + 1);
  sizes[0] = 0.0;
  for (Eigen::Index k = 0; k < steps; ++k) {
    sizes[k + 1] = kSmallest * std::pow(kStep, static_cast<double>(k)) / largest_mode;
  }
  return sizes;
}

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd result(rows, columns);
  for (double& value : result.reshaped()) value = normal(random);
  return result;
}

}  // namespace

EffectOrProcess::EffectOrProcess(const Eigen::VectorXd& y, const Eigen::MatrixXd& Z,
                                 const std::vector<Eigen::MatrixXd>& effects) {
  const linalg::SymmetricModes modes = linalg::symmetric_modes(Z.transpose() * Z);
  const double largest = modes.eigenvalues[modes.eigenvalues.size() - 1];
  Eigen::Index none = 0;
  while (modes.eigenvalues[none] <= kLeastMode * largest) ++none;
  const Eigen::Index count = modes.eigenvalues.size() - none;
  variances_ = modes.eigenvalues.tail(count);
  const Eigen::MatrixXd U =
      Z * modes.eigenvectors.rightCols(count) * variances_.cwiseSqrt().cwiseInverse().asDiagonal();
  sizes_ = sizes_for(largest);
  const Eigen::ArrayXXd excess = (sizes_ * variances_.transpose()).array();
  shares_ = excess / (1.0 + excess);
  log_determinants_ = excess.log1p().rowwise().sum();
  Eigen::MatrixXd Q(y.size(), 0);
  for (const Eigen::MatrixXd& one : effects) {
    first_.push_back(Q.cols());
    linalg::append_columns(Q, linalg::orthonormal_basis(one));
  }
  first_.push_back(Q.cols());
  Q_modes_ = U.transpose() * Q;
  const linalg::SymmetricModes outside =
      linalg::symmetric_modes(Q.transpose() * Q - Q_modes_.transpose() * Q_modes_);
  Q_outside_ = outside.eigenvectors * outside.eigenvalues.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  y_modes_ = U.transpose() * y;
  y_effects_ = Q.transpose() * y;
}

EffectOrProcess::Likeliest EffectOrProcess::likeliest(const Eigen::MatrixXd& in_modes) const {
  Eigen::MatrixXd deviances = -shares_ * in_modes.cwiseAbs2();
  deviances.colwise() += log_determinants_;
  Likeliest result;
  result.deviance.resize(in_modes.cols());
  for (Eigen::Index k = 0; k < in_modes.cols(); ++k) {
    Eigen::Index size = 0;
    result.deviance[k] = deviances.col(k).minCoeff(&size);
    result.size.push_back(size);
  }
  return result;
}

Eigen::MatrixXd EffectOrProcess::claims(const Eigen::MatrixXd& in_modes,
                                        const Eigen::MatrixXd& in_effects) const {
  const Eigen::VectorXd process = likeliest(in_modes).deviance;
  const auto effects = static_cast<Eigen::Index>(first_.size()) - 1;
  Eigen::MatrixXd result(effects, in_modes.cols());
  for (Eigen::Index j = 0; j < effects; ++j) {
    const Eigen::Index first = first_[static_cast<std::size_t>(j)];
    const Eigen::Index count = first_[static_cast<std::size_t>(j) + 1] - first;
    const auto explained = in_effects.middleRows(first, count).colwise().squaredNorm();
    result.row(j) = process.transpose() + explained;
    result.row(j).array() -= 2.0 * static_cast<double>(count);
  }
  return result;
}

double EffectOrProcess::claim(std::size_t effect) const {
  return claims(y_modes_, y_effects_)(static_cast<Eigen::Index>(effect), 0);
}

double EffectOrProcess::likeliest_variance() const {
  return sizes_[likeliest(y_modes_).size.front()];
}

double EffectOrProcess::gain_of_process() const {
  return -likeliest(y_modes_).deviance[0];
}

double EffectOrProcess::chance_of_process(std::size_t effect) const {
  const double s = likeliest_variance();
  std::mt19937_64 random(kSeed);
  const Eigen::VectorXd sds = (1.0 + s * variances_.array()).sqrt();
  const Eigen::MatrixXd drawn = sds.asDiagonal() * normals(sds.size(), kDraws, random);
  const Eigen::MatrixXd seen =
      Q_modes_.transpose() * drawn + Q_outside_ * normals(Q_outside_.cols(), kDraws, random);
  const Eigen::MatrixXd largest = claims(drawn, seen).colwise().maxCoeff();
  const double found = claim(effect);
  const auto reached = (largest.array() >= found).count();
  return static_cast<double>(reached + 1) / static_cast<double>(kDraws + 1);
}

}  // namespace trussmap::criticism
