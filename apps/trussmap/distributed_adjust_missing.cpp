// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "command_line.hpp"
#include "distributed_adjust.hpp"

#include <fmt/format.h>

namespace trussmap::app {

void run_distributed_adjust(const DistributedAdjustOptions& options) {
  throw UsageError(
      fmt::format("--solver {} is not in this build of trussmap: build it with cmake -D "
                  "TRUSSMAP_WITH_MPI=ON (Debian: apt-get install petsc-dev mpi-default-dev)",
                  options.solver));
}

std::string distributed_note() {
  return " (not in this build: cmake -D TRUSSMAP_WITH_MPI=ON)";
}

}  // namespace trussmap::app
