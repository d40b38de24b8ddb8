// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/truss.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap {
namespace {

void require(bool condition) {
  if (!condition) {
    throw std::invalid_argument("a route's covariance must be positive definite, its count > 0");
  }
}

}  // namespace

Matrix2 bar_stiffness(StiffnessLaw law, const Matrix2& covariance, double orientation,
                      double traversals) {
  require(traversals > 0.0);
  if (law == StiffnessLaw::variance) {
    require(covariance(0, 0) > 0.0 && covariance.determinant() > 0.0);
    return traversals * covariance.inverse();
  }
  const Matrix2 R = rotation(orientation);
  const Matrix2 along_bar = R.transpose() * covariance * R;
  require(along_bar(0, 0) > 0.0 && along_bar(1, 1) > 0.0);
  const double dx = std::sqrt(2.0 / std::numbers::pi * along_bar(0, 0));
  const double dy = std::sqrt(2.0 / std::numbers::pi * along_bar(1, 1));
  return R * Vector2(traversals / dx, traversals / dy).asDiagonal() * R.transpose();
}

double spring_stiffness(StiffnessLaw law, double variance, double traversals, double arm) {
  require(variance > 0.0 && traversals > 0.0 && arm > 0.0);
  if (law == StiffnessLaw::variance) return traversals / variance;
  return traversals * arm / std::sqrt(2.0 / std::numbers::pi * variance);
}

}  // namespace trussmap
