// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/exact_increments.hpp"

#include "linalg/dense.hpp"
#include "truss/truss_system.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

// Places kept free: few, because every row added at the end lengthens all later updates; not too
// few, because of what a new factor costs.
constexpr int kLeastSpare = 32;
constexpr int kJointsPerSpare = 64;

[[noreturn]] void refuse() {
  throw SolveError("the covariances of the map's traversals span too many magnitudes");
}

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

ExactIncrements::ExactIncrements(int joints, std::vector<Bar> bars)
    : joints_(joints), bars_(std::move(bars)) {
  for (const Bar& bar : bars_) check(bar.i, bar.j);
}

void ExactIncrements::check(int i, int j) const {
  if (i < 0 || j < 0 || i >= joints_ || j >= joints_ || i == j) {
    throw std::invalid_argument("a bar joins two different joints of the truss");
  }
}

void ExactIncrements::reserve() {
  if (bars_.size() == bars_.capacity()) bars_.reserve(2 * bars_.size() + 2);
}

/// The factor goes with the bars, or is dropped.
template <typename Change>
void ExactIncrements::follow(const Change& change) noexcept {
  if (!factored_) return;
  try {
    change();
  } catch (...) {
    factored_ = false;
  }
}

void ExactIncrements::add_joint(int i, const Matrix2& stiffness) {
  if (i < 0 || i >= joints_) throw std::invalid_argument("the new joint is tied to no joint");
  reserve();
  bars_.push_back({i, joints_, stiffness});
  ++joints_;
  changed_ = -1;
  follow([this] { add_to_factor(bars_.back()); });
}

void ExactIncrements::add_bar(int i, int j, const Matrix2& stiffness) {
  check(i, j);
  reserve();
  bars_.push_back({i, j, stiffness});
  changed_ = static_cast<int>(bars_.size()) - 1;
  stiffness_then_.reset();
  follow([this] { change_factor(bars_.back()); });
}

const Matrix2& ExactIncrements::stiffness(int bar) const {
  return bars_.at(idx(bar)).stiffness;
}

void ExactIncrements::set_stiffness(int bar, const Matrix2& stiffness) {
  Bar& changed = bars_.at(idx(bar));
  changed_ = bar;
  stiffness_then_ = changed.stiffness;
  changed.stiffness = stiffness;
  follow([&] { change_factor({changed.i, changed.j, stiffness - *stiffness_then_}); });
}

void ExactIncrements::take_back() noexcept {
  if (changed_ < 0) return;
  if (stiffness_then_) {
    bars_[idx(changed_)].stiffness = *stiffness_then_;
  } else {
    bars_.pop_back();
  }
  changed_ = -1;
  factored_ = false;
}

std::vector<Vector2> ExactIncrements::pull(int i, int j, const Vector2& force) {
  check(i, j);
  if (!factored_) factorise();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(Eigen::Index{2} * (places_ - 1));
  if (j > 0) u.segment<2>(unknown(j)) += force;
  if (i > 0) u.segment<2>(unknown(i)) -= force;
  cholesky_.solve_updated(u);
  std::vector<Vector2> displacements(idx(joints_), Vector2::Zero());
  for (int joint = 1; joint < joints_; ++joint) {
    displacements[idx(joint)] = u.segment<2>(unknown(joint));
  }
  if (!std::isfinite(u.squaredNorm())) refuse();
  return displacements;
}

/// A change of stiffness may be indefinite: what it adds goes in first, so that K stays definite.
void ExactIncrements::change_factor(const Bar& change) {
  const PlanarModes axes = planar_modes(change.stiffness);
  const Vector2 size = axes.eigenvalues;
  const Matrix2 W = axes.eigenvectors * size.cwiseAbs().cwiseSqrt().asDiagonal();
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
  std::vector<NodePair> ends;
  std::vector<NodePair> couplings;  // of the joints from 1 on
  for (const Bar& bar : bars_) {
    ends.push_back({bar.i, bar.j});
    if (bar.i > 0 && bar.j > 0) couplings.push_back({bar.i - 1, bar.j - 1});
  }
  std::vector<int> order{0};  // which is held
  for (const int joint : elimination_order(joints_ - 1, couplings)) order.push_back(joint + 1);
  for (int spare = joints_; spare < places_; ++spare) order.push_back(spare);
  std::vector<bool> held(idx(places_), false);
  held[0] = true;
  TrussSystem system(held, std::move(ends), order, Kernel::cholmod);
  for (std::size_t bar = 0; bar < bars_.size(); ++bar) {
    system.add_bar(static_cast<int>(bar), bars_[bar].stiffness);
  }
  for (int spare = joints_; spare < places_; ++spare) {
    system.add_ground(spare, Matrix2::Identity());
  }
  cholesky_.analyse(system.matrix());
  try {
    cholesky_.factorise(system.matrix());
  } catch (const NotPositiveDefinite&) {
    refuse();
  }
  unknown_.assign(idx(places_), -1);
  for (int joint = 1; joint < places_; ++joint) unknown_[idx(joint)] = system.offset(joint);
  factored_ = true;
}

}  // namespace trussmap
