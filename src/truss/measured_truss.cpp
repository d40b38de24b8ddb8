// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/measured_truss.hpp"

#include "linalg/connected_parts.hpp"
#include "linalg/dissection.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap::truss {

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

MeasuredTruss::Fit MeasuredTruss::fit(linalg::Kernel kernel) {
  Fit result;
  result.positions = about_;
  if (about_.empty()) return result;
  // A part that nothing holds is not always noticed by its pivots, which may be rounded to any
  // sign.
  const std::vector<int> parts = linalg::connected_parts(joints(), pairs_);
  const auto loose = std::find_if(parts.begin(), parts.end(), [](int part) { return part != 0; });
  if (loose != parts.end()) {
    throw UnsupportedJoint(static_cast<int>(loose - parts.begin()),
                           "is tied to nothing: no chain of measurements leads to it from joint 0");
  }
  std::vector<bool> held(about_.size(), false);
  held[0] = true;
  TrussSystem& K = system_.emplace(held, pairs_, linalg::dissection_order(about_, pairs_), kernel);
  std::vector<Vector2> forces(about_.size(), Vector2::Zero());
  for (int bar = 0; bar < bars(); ++bar) {
    const auto [i, j] = pairs_[idx(bar)];
    const Sums& sums = bars_[idx(bar)];
    K.add_bar(bar, sums.stiffness);
    const Vector2 present = about_[idx(j)] - about_[idx(i)];
    const Vector2 force = sums.stiffness * (sums.first - present) + sums.pull;
    forces[idx(i)] -= force;
    forces[idx(j)] += force;
  }
  K.factorise();
  const std::vector<Vector2> u = K.solve(forces);
  for (int joint = 0; joint < joints(); ++joint) result.positions[idx(joint)] += u[idx(joint)];
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
  return system_->flexibilities();
}

}  // namespace trussmap::truss
