// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Smooth random fields over a square grid: Matern's, of smoothness 1, by a sparse precision.
//
//   (kappa^2 - Laplacian) u = white noise,   kappa = sqrt(8)/length
//   K = kappa^2 C + S,   Q = K C^-1 K/(4 pi kappa^2),   covariance Q^-1
//
//   C        cell^2 on the diagonal               S   the five-point stencil, 4 and -1
//   length   m, where the correlation has come down to 0.14
//
// (Lindgren, Rue & Lindstrom 2011, J. R. Statist. Soc. B 73, equations 2 and 10; their lumped C.)
// The field's variance is 1 in the open. At an edge it would be larger: the grid goes on for a
// length beyond the places that are asked for.
#pragma once

#include "linalg/sparse_cholesky.hpp"
#include "trussmap/planar.hpp"

#include <vector>

#include <Eigen/Core>

namespace trussmap::criticism {

/// A node of a grid: column along x, row along y, from 0 on.
struct GridNode {
  int column = 0;
  int row = 0;
};

/// Nodes `cell` m apart; the first one is at `low`.
struct SquareGrid {
  Vector2 low = Vector2::Zero();
  double cell = 0.0;
  int columns = 0;
  int rows = 0;

  [[nodiscard]] int nodes() const { return columns * rows; }
  /// Row by row.
  [[nodiscard]] int index_of(const GridNode& node) const {
    return node.row * columns + node.column;
  }
  [[nodiscard]] Vector2 place_of(const GridNode& node) const {
    return low + cell * Vector2(node.column, node.row);
  }
};

/// K of all nodes, those of a row one after the other; its lower triangle.
[[nodiscard]] linalg::SparseMatrix matern_operator(const SquareGrid& grid, double length);

/// Of these nodes among each other.
[[nodiscard]] Eigen::MatrixXd matern_covariance(const SquareGrid& grid,
                                                const std::vector<GridNode>& nodes, double length);

}  // namespace trussmap::criticism
