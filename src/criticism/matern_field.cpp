// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/matern_field.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trussmap::criticism {
namespace {

constexpr double kBorder = 1.0;  // lengths

double kappa_of(double length) {
  return std::sqrt(8.0) / length;
}

}  // namespace

linalg::SparseMatrix matern_operator(const SquareGrid& grid, double length) {
  const double own = std::pow(kappa_of(length) * grid.cell, 2);
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(idx(grid.nodes()) * 5);
  const auto join = [&entries](int one, int other) {
    entries.emplace_back(one, one, 1.0);
    entries.emplace_back(other, other, 1.0);
    entries.emplace_back(std::max(one, other), std::min(one, other), -1.0);
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const int at = grid.index_of({column, row});
      entries.emplace_back(at, at, own);
      if (column > 0) join(at - 1, at);
      if (row > 0) join(at - grid.columns, at);
    }
  }
  linalg::SparseMatrix K(grid.nodes(), grid.nodes());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

Eigen::MatrixXd matern_covariance(const SquareGrid& grid, const std::vector<GridNode>& nodes,
                                  double length) {
  const int border = std::max(2, static_cast<int>(std::ceil(kBorder * length / grid.cell)));
  SquareGrid wide = grid;
  wide.low -= border * grid.cell * Vector2::Ones();
  wide.columns += 2 * border;
  wide.rows += 2 * border;
  const linalg::SparseMatrix K = matern_operator(wide, length);
  linalg::SparseCholesky factor;
  factor.analyse(K);
  factor.factorise(K);
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(K.rows(), static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const int at = wide.index_of({nodes[k].column + border, nodes[k].row + border});
    X(at, static_cast<Eigen::Index>(k)) = 1.0;
  }
  X = factor.solve(X);
  const double kappa = kappa_of(length);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(X.cols(), X.cols());
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(
      X.transpose(), 4.0 * std::numbers::pi * std::pow(kappa * grid.cell, 2));
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  return covariance;
}

}  // namespace trussmap::criticism
