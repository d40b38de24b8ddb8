// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The exact increment: recursive least squares in the language of the truss.
//
//   for each traversal with measured vector z and covariance C, first sight included:
//     K += the bar's single-traversal stiffness B = C^-1
//     K u = f,  f = B (z - (p_j - p_i)) on j and -f on i,  the first joint held
//     p += u
//
// After every traversal p is the least-squares map of all measurements so far (to first order:
// covariances are not re-evaluated). K's factor is kept alive and changed by rank-2 updates; only
// a joint that is new since the last solve makes it be built again.
#pragma once

#include "trussmap/core/planar.hpp"
#include "trussmap/truss/truss.hpp"

#include <vector>

namespace trussmap {

class ExactIncrements {
 public:
  /// Joint 0 is held. Each further joint comes with the bar that ties it.
  ExactIncrements() = default;

  /// Joint `joints()` is tied to `i` by a bar that is free of force: nothing moves.
  void add_joint(int i, const Matrix2& stiffness);

  /// Displacements of all joints when a bar i-j that wants to be longer by `misfit` = z - (p_j -
  /// p_i) is built in. Throws std::invalid_argument on joints out of range.
  [[nodiscard]] std::vector<Vector2> add_bar(int i, int j, const Matrix2& stiffness,
                                             const Vector2& misfit);

  [[nodiscard]] int joints() const { return joints_; }

 private:
  void factorise();

  int joints_ = 1;
  int factored_joints_ = 0;
  std::vector<Bar> bars_;
  SparseCholesky cholesky_{Ordering::amd};
};

}  // namespace trussmap
