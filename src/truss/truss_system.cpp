// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/truss_system.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::truss {
namespace {

constexpr double kLeastCondition = 1e-14;
constexpr double kBackwardError = 1e-14;  // componentwise backward error

std::vector<int> sizes_of(const std::vector<bool>& held) {
  std::vector<int> sizes;
  sizes.reserve(held.size());
  for (const bool one : held) sizes.push_back(one ? 0 : 2);
  return sizes;
}

/// f - K u, and the size of the terms that cancel in it.
struct Residual {
  Eigen::VectorXd value;
  Eigen::VectorXd terms;
};

Residual residual_of(const linalg::SparseMatrix& lower, const Eigen::VectorXd& u,
                     const Eigen::VectorXd& f) {
  Residual residual{f, f.cwiseAbs()};
  for (Eigen::Index column = 0; column < lower.cols(); ++column) {
    for (linalg::SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
      const Eigen::Index row = entry.row();
      residual.value[row] -= entry.value() * u[column];
      residual.terms[row] += std::abs(entry.value() * u[column]);
      if (row == column) continue;
      residual.value[column] -= entry.value() * u[row];
      residual.terms[column] += std::abs(entry.value() * u[row]);
    }
  }
  return residual;
}

bool shows_rounding(const Residual& residual) {
  return (residual.value.array().abs() > kBackwardError * residual.terms.array()).any();
}

}  // namespace

TrussSystem::TrussSystem(const std::vector<bool>& held, std::vector<linalg::NodePair> ends,
                         const std::vector<int>& order, linalg::Kernel kernel)
    : ends_(std::move(ends)), joints_(held.size()), K_(sizes_of(held), ends_, order, kernel) {
  for (std::size_t joint = 0; joint < held.size(); ++joint) {
    if (!held[joint]) free_.push_back(static_cast<int>(joint));
  }
}

void TrussSystem::add_bar(int bar, const Matrix2& stiffness) {
  const auto [i, j] = ends_[idx(bar)];
  K_.add_diagonal(i, stiffness);
  K_.add_diagonal(j, stiffness);
  K_.add_coupling(bar, Matrix2(-stiffness));
}

int TrussSystem::joint_of(Eigen::Index unknown) const {
  return *std::find_if(free_.begin(), free_.end(), [&](int joint) {
    return K_.offset(joint) == unknown || K_.offset(joint) + 1 == unknown;
  });
}

void TrussSystem::factorise() {
  if (K_.unknowns() == 0) return;
  try {
    K_.factorise();
  } catch (const linalg::NotPositiveDefinite& failure) {
    throw UnsupportedJoint(joint_of(failure.column()), "can still slide: its bars do not hold it");
  }
}

std::vector<Vector2> TrussSystem::solve(const std::vector<Vector2>& forces) {
  std::vector<Vector2> displacements(joints_, Vector2::Zero());
  if (K_.unknowns() == 0) return displacements;
  Eigen::VectorXd f(K_.unknowns());
  for (const int joint : free_) f.segment<2>(K_.offset(joint)) = forces[idx(joint)];
  Eigen::VectorXd u = f;
  K_.solve_in_place(u);
  if (!(K_.reciprocal_condition() >= kLeastCondition) || !u.allFinite()) {
    Eigen::Index worst = 0;
    u.cwiseAbs().maxCoeff(&worst);
    throw UnsupportedJoint(joint_of(worst), "can still slide: its bars hardly hold it");
  }
  Residual residual = residual_of(K_.matrix(), u, f);
  if (shows_rounding(residual)) {
    K_.solve_in_place(residual.value);
    u += residual.value;
  }
  for (const int joint : free_) displacements[idx(joint)] = u.segment<2>(K_.offset(joint));
  return displacements;
}

std::vector<Matrix2> TrussSystem::flexibilities() const {
  std::vector<Matrix2> result(joints_, Matrix2::Zero());
  if (free_.empty()) return result;
  const Eigen::MatrixXd blocks = K_.inverse_blocks();
  for (const int joint : free_) result[idx(joint)] = blocks.block<2, 2>(0, K_.offset(joint));
  return result;
}

}  // namespace trussmap::truss
