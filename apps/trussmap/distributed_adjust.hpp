// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap adjust --solver petsc|mumps: a truss on many processes. Compiled as
// distributed_adjust.cpp, or as distributed_adjust_missing.cpp where MPI is not built in.
#pragma once

#include <string>

namespace trussmap::app {

struct DistributedAdjustOptions {
  std::string graph;
  std::string out;
  std::string json;
  std::string solver;  ///< "petsc" or "mumps"
  double tolerance = 1e-12;
};

/// Throws UsageError where it is not built in.
void run_distributed_adjust(const DistributedAdjustOptions& options);

/// What --help adds where it is not built in.
[[nodiscard]] std::string distributed_note();

}  // namespace trussmap::app
