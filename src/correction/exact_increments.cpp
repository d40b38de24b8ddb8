// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/correction/exact_increments.hpp"

#include "trussmap/core/index.hpp"

#include <numeric>
#include <stdexcept>

#include <Eigen/Cholesky>

namespace trussmap {

void ExactIncrements::add_joint(int i, const Matrix2& stiffness) {
  if (i < 0 || i >= joints_) throw std::invalid_argument("the new joint is tied to no joint");
  bars_.push_back({i, joints_, stiffness});
  ++joints_;
}

std::vector<Vector2> ExactIncrements::add_bar(int i, int j, const Matrix2& stiffness,
                                              const Vector2& misfit) {
  if (i < 0 || j < 0 || i >= joints_ || j >= joints_ || i == j) {
    throw std::invalid_argument("a bar joins two different joints of the truss");
  }
  bars_.push_back({i, j, stiffness});
  const int unknowns = 2 * (joints_ - 1);
  const auto unknown = [](int joint) { return 2 * (joint - 1); };  // joint 0 is held
  if (factored_joints_ != joints_) {
    factorise();
  } else {
    // B = W W': the bar's columns of the update are W at j and -W at i.
    const Matrix2 W = stiffness.llt().matrixL();
    SparseMatrix update(unknowns, 2);
    std::vector<Eigen::Triplet<double, int>> entries;
    for (int column = 0; column < 2; ++column) {
      for (int row = 0; row < 2; ++row) {
        if (i > 0) entries.emplace_back(unknown(i) + row, column, -W(row, column));
        if (j > 0) entries.emplace_back(unknown(j) + row, column, W(row, column));
      }
    }
    update.setFromTriplets(entries.begin(), entries.end());
    cholesky_.update(update);
  }
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns);
  const Vector2 force = stiffness * misfit;
  if (j > 0) load.segment<2>(unknown(j)) += force;
  if (i > 0) load.segment<2>(unknown(i)) -= force;
  const Eigen::VectorXd u = cholesky_.solve(load);
  std::vector<Vector2> displacements(idx(joints_), Vector2::Zero());
  for (int joint = 1; joint < joints_; ++joint) {
    displacements[idx(joint)] = u.segment<2>(unknown(joint));
  }
  return displacements;
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
