// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/score_test.hpp"

#include <algorithm>

namespace trussmap {

ScoreInformation ScoreTest::information(const SparseMatrix& M) const {
  constexpr Eigen::Index kAtOnce = 128;
  const SparseMatrix J = clean_system_->rows_by_nodes();
  const SparseMatrix B = J.transpose() * M;
  const SparseMatrix Bt = B.transpose();
  ScoreInformation result;
  result.G = Eigen::MatrixXd(SparseMatrix(M.transpose() * M));
  for (Eigen::Index first = 0; first < M.cols(); first += kAtOnce) {
    const Eigen::Index count = std::min(kAtOnce, M.cols() - first);
    const Eigen::MatrixXd some = B.middleCols(first, count);
    result.G.middleCols(first, count) -= Bt * clean_system_->solve_nodes(some);
  }
  const Eigen::MatrixXd shared = M.transpose() * present_;
  result.G.noalias() -= shared * shared.transpose();
  result.G = 0.5 * (result.G + result.G.transpose()).eval();
  result.s = M.transpose() * residuals_;
  return result;
}

}  // namespace trussmap
