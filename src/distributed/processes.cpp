// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/communicator.hpp"
#include "trussmap/distributed.hpp"

#include <cstdlib>

namespace trussmap {

Processes::Processes() {
  require_mpi(MPI_Init(nullptr, nullptr), "anything");
  const Communicator all;
  rank_ = all.rank();
  count_ = all.count();
}

Processes::~Processes() {
  MPI_Finalize();
}

std::vector<std::string> Processes::gather(const std::string& text) const {
  return Communicator().gather(text);
}

std::string Processes::spread(const std::string& text) const {
  return Communicator().from(0, text);
}

void Processes::abort(int status) const {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::abort();
}

bool launched_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

}  // namespace trussmap
