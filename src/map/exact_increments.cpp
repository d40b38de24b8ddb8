// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/exact_increments.hpp"

#include "linalg/block_system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace trussmap {
namespace {

// Places kept free: few, because every row added at the end lengthens all later updates; not too
// few, because of what a new factor costs.
constexpr int kLeastSpare = 32;
constexpr int kJointsPerSpare = 64;

/// One column per column of `w`: +w from unknown j on, -w from unknown i on; negative: held.
SparseMatrix between(int i, int j, const Eigen::Matrix<double, 2, Eigen::Dynamic>& w,
                     int unknowns) {
  SparseMatrix W(unknowns, w.cols());
  W.reserve(Eigen::VectorXi::Constant(w.cols(), 4));
  for (int c = 0; c < w.cols(); ++c) {
    for (int row = 0; row < 2; ++row) {
      if (i >= 0) W.insert(i + row, c) = -w(row, c);
      if (j >= 0) W.insert(j + row, c) = w(row, c);
    }
  }
  W.makeCompressed();
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
  if (factored_) add_to_factor(bars_.back());
}

void ExactIncrements::add_bar(int i, int j, const Matrix2& stiffness) {
  check(i, j);
  bars_.push_back({i, j, stiffness});
  if (factored_) change_factor(bars_.back());
}

const Matrix2& ExactIncrements::stiffness(int bar) const {
  return bars_.at(idx(bar)).stiffness;
}

void ExactIncrements::set_stiffness(int bar, const Matrix2& stiffness) {
  Bar& changed = bars_.at(idx(bar));
  if (factored_) change_factor({changed.i, changed.j, stiffness - changed.stiffness});
  changed.stiffness = stiffness;
}

std::vector<Vector2> ExactIncrements::pull(int i, int j, const Vector2& force) {
  check(i, j);
  if (!factored_) factorise();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(2 * (places_ - 1));
  if (j > 0) u.segment<2>(unknown(j)) += force;
  if (i > 0) u.segment<2>(unknown(i)) -= force;
  cholesky_.solve_updated(u);
  std::vector<Vector2> displacements(idx(joints_), Vector2::Zero());
  for (int joint = 1; joint < joints_; ++joint) {
    displacements[idx(joint)] = u.segment<2>(unknown(joint));
  }
  return displacements;
}

/// A change of stiffness may be indefinite: what it adds goes in first, so that K stays definite.
void ExactIncrements::change_factor(const Bar& change) {
  const Eigen::SelfAdjointEigenSolver<Matrix2> axes(change.stiffness);
  const Vector2 size = axes.eigenvalues();
  const Matrix2 W = axes.eigenvectors() * size.cwiseAbs().cwiseSqrt().asDiagonal();
  const auto columns = [&](int first, int count) {
    return between(unknown(change.i), unknown(change.j), W.middleCols(first, count),
                   2 * (places_ - 1));
  };
  const int negative = (size[0] < 0.0 ? 1 : 0) + (size[1] < 0.0 ? 1 : 0);  // eigenvalues ascend
  if (negative < 2) cholesky_.update(columns(negative, 2 - negative));
  if (negative > 0) cholesky_.downdate(columns(0, negative));
}

/// The joint's place has been waiting for it, tied to the ground alone.
void ExactIncrements::add_to_factor(const Bar& tie) {
  if (joints_ > places_) {
    factored_ = false;
    return;
  }
  change_factor({0, tie.i, tie.i > 0 ? tie.stiffness : Matrix2(Matrix2::Zero())});
  const int unknowns = 2 * (places_ - 1);
  const int at = unknown(tie.j);
  for (int c = 0; c < 2; ++c) {
    SparseMatrix column(unknowns, 1);
    column.reserve(4);
    for (int r = 0; r < 2 && tie.i > 0; ++r) {
      column.insert(unknown(tie.i) + r, 0) = -tie.stiffness(r, c);
    }
    for (int r = 0; r <= c; ++r) column.insert(at + r, 0) = tie.stiffness(r, c);
    column.makeCompressed();
    cholesky_.add_row(at + c, column);
  }
}

void ExactIncrements::factorise() {
  places_ = joints_ + std::max(kLeastSpare, joints_ / kJointsPerSpare);
  std::vector<NodePair> pairs;
  for (const Bar& bar : bars_) {
    if (bar.i > 0 && bar.j > 0) pairs.push_back({bar.i - 1, bar.j - 1});
  }
  const std::vector<int> order = elimination_order(joints_ - 1, pairs);
  std::vector<int> number(idx(places_), -1);  // joint 0 is held
  for (std::size_t k = 0; k < order.size(); ++k) number[idx(order[k]) + 1] = static_cast<int>(k);
  std::vector<Bar> bars = bars_;
  for (int spare = joints_; spare < places_; ++spare) {
    number[idx(spare)] = spare - 1;
    bars.push_back({0, spare, Matrix2::Identity()});
  }
  const SparseMatrix K = assemble(bars, number, places_ - 1);
  cholesky_.analyse(K);
  cholesky_.factorise(K);
  unknown_.assign(idx(places_), -1);
  for (int joint = 1; joint < places_; ++joint) unknown_[idx(joint)] = 2 * number[idx(joint)];
  factored_ = true;
}

}  // namespace trussmap
