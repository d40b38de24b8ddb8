// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sparse Cholesky factorisation front by front: the library's own kernel.
//
//   A = L L'    A in the order of its front tree (front_tree.hpp), lower triangle
//
//   front   [F11  .  ]   F11 = L11 L11',  L21 = F21 L11^-T,  U = F22 - L21 L21'
//           [F21  F22]   U is added to the parent's front, row by row
//
// Everything is dense algebra on fronts; sparse indices are met only where U is added to the
// parent. Faster than CHOLMOD (SparseCholesky, what it is checked against) in maps of some size
// (bench/README.md).
//
// The inverse where L has entries comes down the tree, from parents to children:
//   Z_21 = -Z_22 L21 L11^-1,   Z_11 = L11^-T L11^-1 - (L21 L11^-1)' Z_21
// and Z_22 is found in the parent's front (Takahashi, Fagan & Chin, 1973; by fronts: Campbell &
// Davis, "Computing the sparse inverse subset: an inverse multifrontal approach", 1995).
//
// Subtrees and the tiles of large fronts are worked on by several threads (trussmap/running.hpp);
// each number comes from the same operations in the same order, whoever does them.
//
// Memory: L, and the updates that wait for their parents.
#pragma once

#include "linalg/front_tree.hpp"
#include "linalg/large_array.hpp"
#include "linalg/sparse_cholesky.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace trussmap::linalg {

class FrontalInverse;

class FrontalCholesky {
 public:
  FrontalCholesky() = default;

  /// `sizes`: unknowns per place of the tree.
  FrontalCholesky(const FrontTree& tree, const std::vector<int>& sizes);

  /// `lower`: in the order of the tree, its pattern within the tree's, each column's diagonal
  /// first. Throws NotPositiveDefinite.
  void factorise(const SparseMatrix& lower);

  /// A x = b; `x` holds b before and the solution after. Call after factorise.
  void solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const;
  /// A X = B likewise, many columns at once; a column's digits do not depend on the others.
  void solve_columns(Eigen::MatrixXd& x) const;

  /// B' A^-1 B, of columns with few entries each: (row, column, value), those of one place are
  /// added up. Cost: the fronts from the entries up to the root, once for
  /// all columns.
  [[nodiscard]] Eigen::MatrixXd inverse_products(const std::vector<Eigen::Triplet<double>>& b,
                                                 int columns) const;

  /// Diagonal blocks of A^-1: column k of the result is unknown k's, its rows those of the
  /// unknowns of its node, as many as the largest node has (the rest zero).
  [[nodiscard]] Eigen::MatrixXd inverse_blocks() const;

  /// A^-1 where L has entries, kept: as many numbers as L has. Call after factorise; it is to be
  /// used no longer than this factorisation lives.
  [[nodiscard]] FrontalInverse inverse() const;

  [[nodiscard]] double log_determinant() const;
  /// Reciprocal of a rough condition number, (min L_ii / max L_ii)^2.
  [[nodiscard]] double reciprocal_condition() const;
  /// The least share that elimination has left of an entry of A's diagonal, as
  /// SparseCholesky::least_pivot_share.
  [[nodiscard]] double least_pivot_share(const Eigen::VectorXd& diagonal) const;
  /// Numbers stored for L.
  [[nodiscard]] double stored() const { return static_cast<double>(stored_); }

 private:
  friend class FrontalInverse;

  using Update = LargeArray;
  struct FrontRange {
    std::size_t begin, end;
  };
  struct Run {  ///< consecutive rows that are consecutive in the parent's front as well
    int from, to, length;
  };
  struct Part {
    std::size_t panel;  ///< where the front's columns are stored
    int unknown;        ///< first unknown eliminated
    int rows, width;
    int parent;
    int subtree_begin;                 ///< first front of those below it
    double work;                       ///< multiplications of it and of those below it
    int children_begin, children_end;  ///< in children_
    int runs_begin, runs_end;          ///< in runs_: its rows in the parent's front
    int scalars_begin;                 ///< in scalars_: unknowns of the rows that remain

    [[nodiscard]] int height() const { return rows - width; }
  };

  void number_rows(const FrontTree& tree);
  [[nodiscard]] std::size_t front_of(int unknown) const;
  void list_children();
  void find_runs();
  void add_up_work();
  /// Ranges of fronts, whole subtrees, that may be eliminated at the same time.
  [[nodiscard]] std::vector<FrontRange> independent_ranges() const;
  void eliminate_range(const FrontRange& range, const SparseMatrix& lower,
                       std::vector<Update>& waiting);
  void assemble(const Part& front, const SparseMatrix& lower, const std::vector<Update>& waiting,
                int* where, double* update);
  void add_update(const Part& child, const double* from, const Part& front, double* update);
  void copy_rows(const Part& front, const double* parent, int above, double* inverse) const;
  /// From the root down: `visit` gets each front and its whole inverse, rows square.
  template <typename Visit>
  void descend(const Visit& visit) const;
  void solve_some(Eigen::Ref<Eigen::MatrixXd> x) const;

  std::vector<Part> parts_;
  std::vector<int> children_;
  std::vector<Run> runs_;
  std::vector<int> scalars_;
  std::vector<int> node_begin_;  ///< per node its first unknown, and one past the last
  std::size_t stored_ = 0;
  int most_rows_ = 0;
  LargeArray panels_;
};

/// Entries of A^-1, A in the order of the front tree.
class FrontalInverse {
 public:
  /// rows x columns of them, from (row, column) on, within one node each: nodes that the matrix
  /// couples, or one with itself. std::out_of_range where L has no entry.
  [[nodiscard]] Eigen::MatrixXd block(int row, int rows, int column, int columns) const;

 private:
  friend class FrontalCholesky;
  explicit FrontalInverse(const FrontalCholesky& factor);

  const FrontalCholesky& factor_;
  LargeArray entries_;  ///< the fronts' first columns, as L's are stored
};

}  // namespace trussmap::linalg
