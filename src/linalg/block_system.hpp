// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A symmetric positive definite system whose unknowns come in small blocks, one per node: two for
// a joint, three for a pose. The pattern is laid out once, in an order that keeps the factor
// sparse; after that each block is added straight into its place, with no sorting.
//
//   A = sum over nodes of diagonal blocks + sum over pairs of couplings (and their transposes)
//
//   node    0, 1, ...; of `size` unknowns, 0 = held: what is added to it or its pairs is dropped
//   pair    two nodes that are coupled; several pairs may join the same two nodes
//
// The vectors of this system are in its own order: node k's part begins at offset(k).
#pragma once

#include "geometry/index.hpp"
#include "linalg/front_tree.hpp"
#include "linalg/frontal_cholesky.hpp"
#include "linalg/sparse_cholesky.hpp"

#include <array>
#include <vector>

namespace trussmap::linalg {

/// All nodes, held ones too, in an order with little fill, and what it costs.
struct Elimination {
  std::vector<int> order;
  double multiplications = 0.0;  ///< of a factorisation with one unknown per node
};
/// Approximate minimum degree (CHOLMOD's analysis).
[[nodiscard]] Elimination plan_elimination(int nodes, const std::vector<NodePair>& pairs);
[[nodiscard]] std::vector<int> elimination_order(int nodes, const std::vector<NodePair>& pairs);

/// Who factorises: the library's own kernel, or CHOLMOD.
enum class Kernel { frontal, cholmod };

class BlockSystem {
 public:
  static constexpr int kLargestBlock = 4;

  /// Lays out the pattern; eliminates nodes in the given order (a permutation of all nodes) or in
  /// one with the same fill.
  BlockSystem(const std::vector<int>& sizes, const std::vector<NodePair>& pairs,
              const std::vector<int>& order, Kernel kernel = Kernel::frontal);

  [[nodiscard]] int nodes() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int unknowns() const { return unknowns_; }
  [[nodiscard]] int size(int node) const { return nodes_[idx(node)].size; }
  /// Where the node's unknowns begin; meaningless for a held node.
  [[nodiscard]] int offset(int node) const { return nodes_[idx(node)].offset; }

  void clear();

  /// Adds a symmetric size x size block at a node.
  template <int N>
  void add_diagonal(int node, const Eigen::Matrix<double, N, N>& block);

  /// Adds the block that couples the pair's first node (rows) to its second (columns).
  template <int Rows, int Columns>
  void add_coupling(int pair, const Eigen::Matrix<double, Rows, Columns>& block);

  [[nodiscard]] Eigen::VectorXd diagonal() const;
  void set_diagonal(const Eigen::VectorXd& values);

  /// Throws NotPositiveDefinite; its column is an unknown of this system.
  void factorise();
  void solve_in_place(Eigen::VectorXd& x);
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// B' A^-1 B, of columns with few entries each: (row, column, value), those of one place are
  /// added up. Call after factorise. Cost: the fronts from the entries up to the root.
  [[nodiscard]] Eigen::MatrixXd inverse_products(const std::vector<Eigen::Triplet<double>>& b,
                                                 int columns) const;

  /// Diagonal blocks of A^-1, the covariances of all nodes: the node's stands in rows 0 ... size-1
  /// of columns offset ... offset+size-1. Call after factorise. Cost: twice the
  /// operations of a factorisation, about 1.4 times its time.
  [[nodiscard]] Eigen::MatrixXd inverse_blocks() const;

  /// A^-1 between nodes that are coupled, and of each with itself; of Kernel::frontal alone
  /// (std::logic_error). Call after factorise; not to be used once this system is gone.
  [[nodiscard]] FrontalInverse inverse() const;

  [[nodiscard]] double log_determinant() const;
  [[nodiscard]] double reciprocal_condition() const;
  /// The least share that elimination has left of a diagonal entry: SparseCholesky's. Call before
  /// the matrix changes again.
  [[nodiscard]] double least_pivot_share() const;

  /// The lower triangle of A.
  [[nodiscard]] const SparseMatrix& matrix() const { return matrix_; }

 private:
  struct Node {
    int size = 0;
    int offset = 0;
    std::array<int, kLargestBlock> column{};  ///< where each column's values begin (its diagonal)
  };
  struct Coupling {
    int node = -1;  ///< whose columns hold the block; -1: one of the two is held
    int row = 0;    ///< how far below the node's diagonal block
    bool transposed = false;
  };

  void lay_out(const BlockPattern& pattern, const std::vector<NodePair>& pairs,
               const std::vector<int>& order, const std::vector<int>& place);

  std::vector<Node> nodes_;
  std::vector<Coupling> couplings_;
  std::vector<int> diagonal_;
  int unknowns_ = 0;
  SparseMatrix matrix_;
  Kernel kernel_;
  FrontalCholesky frontal_;
  SparseCholesky cholmod_{Ordering::natural};
  bool analysed_ = false;  ///< by CHOLMOD
};

template <int N>
void BlockSystem::add_diagonal(int node, const Eigen::Matrix<double, N, N>& block) {
  const Node& n = nodes_[idx(node)];
  if (n.size == 0) return;
  for (int c = 0; c < N; ++c) {
    double* column = matrix_.valuePtr() + n.column[idx(c)];
    for (int r = c; r < N; ++r) column[r - c] += block(r, c);
  }
}

template <int Rows, int Columns>
void BlockSystem::add_coupling(int pair, const Eigen::Matrix<double, Rows, Columns>& block) {
  const Coupling& at = couplings_[idx(pair)];
  if (at.node < 0) return;
  const Node& n = nodes_[idx(at.node)];
  if (at.transposed) {
    for (int r = 0; r < Rows; ++r) {
      double* column = matrix_.valuePtr() + n.column[idx(r)] + (Rows - r) + at.row;
      for (int c = 0; c < Columns; ++c) column[c] += block(r, c);
    }
  } else {
    for (int c = 0; c < Columns; ++c) {
      double* column = matrix_.valuePtr() + n.column[idx(c)] + (Columns - c) + at.row;
      for (int r = 0; r < Rows; ++r) column[r] += block(r, c);
    }
  }
}

}  // namespace trussmap::linalg
