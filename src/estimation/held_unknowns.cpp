// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/held_unknowns.hpp"

namespace trussmap::estimation {

void hold_unknowns(linalg::BlockSystem& A, Eigen::VectorXd& gradient,
                   const std::vector<std::uint8_t>& held) {
  Eigen::VectorXd diagonal;
  for (int node = 0; node < static_cast<int>(held.size()); ++node) {
    if (held[idx(node)] == held_nothing) continue;
    for (int k = 0; k < A.size(node); ++k) {
      if (!is_held(held[idx(node)], k)) continue;
      if (diagonal.size() == 0) diagonal = A.diagonal();
      diagonal[A.offset(node) + k] = 1.0;
      gradient[A.offset(node) + k] = 0.0;
    }
  }
  if (diagonal.size() > 0) A.set_diagonal(diagonal);
}

}  // namespace trussmap::estimation
