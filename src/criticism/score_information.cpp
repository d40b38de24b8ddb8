// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/score_test.hpp"

#include <algorithm>

namespace trussmap::criticism {

ScoreInformation ScoreTest::information(const linalg::SparseMatrix& M) const {
  constexpr Eigen::Index kAtOnce = 128;
  const linalg::SparseMatrix J = clean_system_->rows_by_nodes();
  const linalg::SparseMatrix B = J.transpose() * M;
  const linalg::SparseMatrix Bt = B.transpose();
  ScoreInformation result;
  result.G = Eigen::MatrixXd(linalg::SparseMatrix(M.transpose() * M));
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

}  // namespace trussmap::criticism
