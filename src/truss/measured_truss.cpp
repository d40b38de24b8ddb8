// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/measured_truss.hpp"

#include "linalg/connected_parts.hpp"
#include "linalg/dissection.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

namespace trussmap {

int MeasuredTruss::add_joint(const Vector2& about) {
  about_.push_back(about);
  bars_at_.push_back(-1);
  system_.reset();
  return joints() - 1;
}

void MeasuredTruss::add(int i, int j, const Vector2& displacement, const Matrix2& information) {
  if (i < 0 || j < 0 || i >= joints() || j >= joints() || i == j) {
    throw std::invalid_argument("a measurement joins two different joints");
  }
  if (!(information(0, 0) > 0.0 && information.determinant() > 0.0) || !displacement.allFinite()) {
    throw std::invalid_argument("a measurement is finite, its information positive definite");
  }
  const bool upwards = i < j;
  Sums& bar = bars_[idx(upwards ? bar_between(i, j) : bar_between(j, i))];
  const Vector2 z = upwards ? displacement : Vector2(-displacement);
  if (bar.stiffness(0, 0) == 0.0) bar.first = z;
  const Vector2 off = z - bar.first;
  const Vector2 pull = information * off;
  bar.stiffness += information;
  bar.pull += pull;
  bar.scatter += off.dot(pull);
  ++measurements_;
  system_.reset();
}

int MeasuredTruss::bar_between(int low, int high) {
  int& last = bars_at_[idx(low)];
  for (int bar = last; bar >= 0; bar = bars_[idx(bar)].next) {
    if (pairs_[idx(bar)][1] == high) return bar;
  }
  Sums sums;
  sums.next = last;
  last = bars();
  bars_.push_back(sums);
  pairs_.push_back({low, high});
  return last;
}

MeasuredTruss::Fit MeasuredTruss::fit(Kernel kernel) {
  Fit result;
  result.positions = about_;
  if (about_.empty()) return result;
  // A part that nothing holds is not always noticed by its pivots, which may be rounded to any
  // sign.
  const std::vector<int> parts = connected_parts(joints(), pairs_);
  const auto loose = std::find_if(parts.begin(), parts.end(), [](int part) { return part != 0; });
  if (loose != parts.end()) {
    throw SolveError("joint " + std::to_string(loose - parts.begin()) +
                     " is tied to nothing: no chain of measurements leads to it from joint 0");
  }
  std::vector<int> sizes(about_.size(), 2);
  sizes[0] = 0;
  BlockSystem& K = system_.emplace(sizes, pairs_, dissection_order(about_, pairs_), kernel);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(K.unknowns());
  for (int bar = 0; bar < bars(); ++bar) {
    const auto [i, j] = pairs_[idx(bar)];
    const Sums& sums = bars_[idx(bar)];
    K.add_diagonal(i, sums.stiffness);
    K.add_diagonal(j, sums.stiffness);
    K.add_coupling(bar, Matrix2(-sums.stiffness));
    const Vector2 present = about_[idx(j)] - about_[idx(i)];
    const Vector2 force = sums.stiffness * (sums.first - present) + sums.pull;
    if (K.size(i) > 0) u.segment<2>(K.offset(i)) -= force;
    if (K.size(j) > 0) u.segment<2>(K.offset(j)) += force;
  }
  K.factorise();
  K.solve_in_place(u);
  for (int joint = 0; joint < joints(); ++joint) {
    if (K.size(joint) > 0) result.positions[idx(joint)] += u.segment<2>(K.offset(joint));
  }
  for (int bar = 0; bar < bars(); ++bar) {
    const auto [i, j] = pairs_[idx(bar)];
    const Sums& sums = bars_[idx(bar)];
    const Vector2 off = result.positions[idx(j)] - result.positions[idx(i)] - sums.first;
    result.chi2 += off.dot(sums.stiffness * off - 2.0 * sums.pull) + sums.scatter;
  }
  result.dof = static_cast<int>(2 * (measurements_ - joints() + 1));
  return result;
}

std::vector<Matrix2> MeasuredTruss::covariances() const {
  if (!system_) throw std::logic_error("covariances are those of a fit, which has to come first");
  const Eigen::MatrixXd blocks = system_->inverse_blocks();
  std::vector<Matrix2> result(about_.size(), Matrix2::Zero());
  for (int joint = 0; joint < joints(); ++joint) {
    if (system_->size(joint) == 0) continue;
    result[idx(joint)] = blocks.block<2, 2>(0, system_->offset(joint));
  }
  return result;
}

}  // namespace trussmap
