// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A sparse factor that changes with its matrix: A = L D L', L with unit diagonal, column by column.
//
//   update     A + W W'    along the paths of W's columns to the root of the elimination tree
//   downdate   A - W W'    (Davis and Hager, SIAM J. Matrix Anal. Appl. 20, 606, 1999; by method C1
//                          of Gill, Golub, Murray and Saunders, Math. Comp. 28, 505, 1974)
//   add_row    a row and column of the identity become others
//                          (Davis and Hager, ibid. 26, 621, 2005)
//
// Rows of a column are kept in ascending order; the first is the column's parent in the tree.
// Everything is in the order of the factor.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace trussmap::linalg {

/// One entry of a sparse column.
struct FactorEntry {
  int row = 0;
  double value = 0.0;
};

class UpdatableFactor {
 public:
  /// Of n columns: `pivots` D, and L below its diagonal, rows ascending.
  explicit UpdatableFactor(int n);
  /// The next column, from 0 on.
  void append_column(double pivot, const int* rows, const double* values, int count);

  /// W's columns have the same rows, ascending. Throws NotPositiveDefinite with the place where
  /// a downdated matrix is not; the factor is then of no further use.
  void change(bool add, const std::vector<std::vector<FactorEntry>>& w);

  /// Row and column `place` of A, until now those of the identity, become `column` (rows ascending,
  /// its diagonal entry among them). Throws NotPositiveDefinite.
  void add_row(int place, const std::vector<FactorEntry>& column);

  /// A x = b; `x` holds b before and the solution after. Skips what is zero in b.
  void solve_in_place(Eigen::VectorXd& x) const;

  [[nodiscard]] const std::vector<double>& pivots() const { return pivots_; }
  [[nodiscard]] double nonzeros() const;

 private:
  struct Column {
    std::size_t begin = 0;  ///< in rows_ and values_
    int count = 0;
    int room = 0;
  };

  /// Room for so many rows, what is there moved along.
  void reserve(int column, int count);
  /// Adds rows (ascending, none of them there) with value 0.
  void insert(int column, const std::vector<int>& rows);
  /// Those of `rows` that the column has not.
  [[nodiscard]] std::vector<int> missing_in(int column, const std::vector<int>& rows) const;
  [[nodiscard]] int parent_of(int column) const;
  /// What a row and column that come in leave of their pivot, and the rows below.
  struct AddedColumn {
    double pivot = 0.0;
    std::vector<int> below;  ///< ascending; marked, their numbers in work_
  };
  AddedColumn fill_row(int place, const std::vector<FactorEntry>& column);
  /// What the rest of the factor is to be downdated by.
  std::vector<FactorEntry> fill_column(int place, const AddedColumn& added);
  /// Moves columns together when half of the storage is holes.
  void compact();
  /// Each column's rows are its successor and those of its successor.
  [[nodiscard]] bool follow_each_other(int first, int count) const;
  template <int Width>
  struct Panel;
  /// Along one path, one or two columns in work_.
  template <int Columns>
  void follow(bool add, std::vector<int> pattern);

  std::vector<double> pivots_;
  std::vector<Column> columns_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::size_t used_ = 0;               ///< rows of all columns
  std::vector<Eigen::Vector2d> work_;  ///< zero between calls
  std::vector<char> marked_;           ///< likewise
};

}  // namespace trussmap::linalg
