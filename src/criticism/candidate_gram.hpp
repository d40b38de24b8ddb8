// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Inner products of all candidates' columns: with them any set of candidates is fitted to first
// order without a look at the rows again.
//
//   M_i   projected columns of candidate i (score_test.hpp), rows x shapes
//   X_i = M_i W_i, orthonormal: X_i' X_i = 1;  u_i = X_i' r, a standard error each;
//         coefficients = -W_i u_i
//   G   = X' X, its blocks on the diagonal 1;   g = X' r
//
// Of a set S:  u_S = G_SS^-1 g_S,  chi^2 that it takes away = g_S' u_S.
#pragma once

#include "criticism/score_test.hpp"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace trussmap::criticism {

/// A candidate among the columns.
struct ColumnBlock {
  std::size_t candidate = 0;  ///< place among those that were added
  Eigen::Index first = 0;     ///< column
  Eigen::Index size = 0;      ///< columns, at least one
  Eigen::MatrixXd weights;    ///< W, shapes x size; rows of 0 where unseen
  /// Largest |g| of each shape in standard deviations of what is known of its channel, per unit of
  /// its coefficient; 0 of a plain factor, which may be of any size.
  Eigen::VectorXd in_priors;
};

struct CandidateGram {
  Eigen::MatrixXd G;  ///< symmetric
  Eigen::VectorXd g;
  std::vector<ColumnBlock> blocks;
};

/// Most columns of a candidate that counts among sets: a map of the floor is no cause.
inline constexpr Eigen::Index kMostColumnsOfOne = 8;

/// Gathers columns, candidate by candidate.
class GramBuilder {
 public:
  /// `rows`: of the residuals.
  explicit GramBuilder(Eigen::Index rows) : rows_(rows) {}

  /// Nothing of a candidate that cannot be seen, or has too many columns; nothing any more once
  /// there would be more than 200 MB of columns. The score has its columns.
  void add(std::size_t candidate, const Effect& effect, const Score& score);

  [[nodiscard]] bool empty() const { return blocks_.empty(); }

  /// Of all that were added. The sums do not depend on the number of threads.
  [[nodiscard]] CandidateGram gram(const Eigen::VectorXd& residuals) const;

 private:
  Eigen::Index rows_;
  std::vector<ColumnBlock> blocks_;
  std::vector<Eigen::MatrixXd> columns_;  ///< X
  Eigen::Index count_ = 0;
};

}  // namespace trussmap::criticism
