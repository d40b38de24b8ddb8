// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/correction/exact_increments.hpp"

#include "trussmap/core/index.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace trussmap {
namespace {

int unknown(int joint) {
  return 2 * (joint - 1);  // joint 0 is held
}

/// The columns w at j and -w at i: what a stiffness w w' between them adds to K is W W'.
SparseMatrix between(int i, int j, const Vector2& w, int unknowns) {
  SparseMatrix W(unknowns, 1);
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int row = 0; row < 2; ++row) {
    if (i > 0) entries.emplace_back(unknown(i) + row, 0, -w(row));
    if (j > 0) entries.emplace_back(unknown(j) + row, 0, w(row));
  }
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

}  // namespace

void ExactIncrements::check(int i, int j) const {
  if (i < 0 || j < 0 || i >= joints_ || j >= joints_ || i == j) {
    throw std::invalid_argument("a bar joins two different joints of the truss");
  }
}

void ExactIncrements::add_joint(int i, const Matrix2& stiffness) {
  if (i < 0 || i >= joints_) throw std::invalid_argument("the new joint is tied to no joint");
  bars_.push_back({i, joints_, stiffness});
  ++joints_;
}

void ExactIncrements::add_bar(int i, int j, const Matrix2& stiffness) {
  check(i, j);
  bars_.push_back({i, j, stiffness});
  if (factored()) change_factor(bars_.back());
}

const Matrix2& ExactIncrements::stiffness(int bar) const {
  return bars_.at(idx(bar)).stiffness;
}

void ExactIncrements::set_stiffness(int bar, const Matrix2& stiffness) {
  Bar& changed = bars_.at(idx(bar));
  if (factored()) change_factor({changed.i, changed.j, stiffness - changed.stiffness});
  changed.stiffness = stiffness;
}

std::vector<Vector2> ExactIncrements::pull(int i, int j, const Vector2& force) {
  check(i, j);
  if (!factored()) factorise();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknown(joints_));
  if (j > 0) load.segment<2>(unknown(j)) += force;
  if (i > 0) load.segment<2>(unknown(i)) -= force;
  const Eigen::VectorXd u = cholesky_.solve(load);
  std::vector<Vector2> displacements(idx(joints_), Vector2::Zero());
  for (int joint = 1; joint < joints_; ++joint) {
    displacements[idx(joint)] = u.segment<2>(unknown(joint));
  }
  return displacements;
}

/// A change of stiffness may be indefinite: what it adds goes in first, so that K stays definite.
void ExactIncrements::change_factor(const Bar& change) {
  const Eigen::SelfAdjointEigenSolver<Matrix2> axes(change.stiffness);
  for (const int axis : {1, 0}) {  // eigenvalues ascend
    const double value = axes.eigenvalues()(axis);
    const Vector2 w = std::sqrt(std::abs(value)) * axes.eigenvectors().col(axis);
    const SparseMatrix W = between(change.i, change.j, w, unknown(joints_));
    if (value > 0.0) cholesky_.update(W);
    if (value < 0.0) cholesky_.downdate(W);
  }
}

void ExactIncrements::factorise() {
  std::vector<int> numbers(idx(joints_));
  std::iota(numbers.begin(), numbers.end(), -1);  // joint 0 held
  const SparseMatrix K = assemble(bars_, numbers, joints_ - 1);
  cholesky_.analyse(K);
  cholesky_.factorise(K);
  factored_joints_ = joints_;
}

}  // namespace trussmap
