// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/damped_step.hpp"

namespace trussmap::linalg {

void factorise_damped(BlockSystem& A, double damping, double least) {
  if (A.unknowns() == 0) return;
  if (!(damping > 0.0)) {
    A.factorise();
    return;
  }
  const Eigen::VectorXd diagonal = A.diagonal();
  if (least > 0.0) {
    A.set_diagonal(diagonal + damping * diagonal.cwiseMax(least * diagonal.maxCoeff()));
  } else {
    A.set_diagonal((1.0 + damping) * diagonal);
  }
  try {
    A.factorise();
  } catch (...) {
    A.set_diagonal(diagonal);
    throw;
  }
  A.set_diagonal(diagonal);
}

double predicted_decrease(const Eigen::VectorXd& step, const Eigen::VectorXd& gradient,
                          const Eigen::VectorXd& diagonal, double damping) {
  const double undamped = -step.dot(gradient);
  return damping > 0.0 ? undamped + damping * step.cwiseAbs2().dot(diagonal) : undamped;
}

bool is_rounding(const Eigen::VectorXd& step, double size) {
  return step.size() == 0 || step.cwiseAbs().maxCoeff() <= kRounding * size;
}

}  // namespace trussmap::linalg
