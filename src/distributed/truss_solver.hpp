// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// K u = f by PETSc: conjugate gradients with algebraic multigrid, or MUMPS, corrected from the true
// residual until it is small enough.
#pragma once

#include "distributed/petsc_objects.hpp"
#include "trussmap/distributed.hpp"

namespace trussmap::distributed {

struct Solution {
  OwnedVector u;
  int iterations = 0;
  double residual = 0.0;  ///< |f - K u| / |f|
  bool converged = false;
  double complexity = 0.0;
  double seconds_preparing = 0.0;
  double seconds_solving = 0.0;
};

[[nodiscard]] Solution solve_equations(Mat K, Vec f, const DistributedOptions& options);

}  // namespace trussmap::distributed
