// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/communicator.hpp"
#include "trussmap/distributed.hpp"

#include <chrono>
#include <cstdlib>
#include <thread>

namespace trussmap {
using namespace distributed;

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

bool Processes::all_come(double seconds) const {
  MPI_Request request = MPI_REQUEST_NULL;
  require_mpi(MPI_Ibarrier(MPI_COMM_WORLD, &request), "anything");
  const double end = MPI_Wtime() + seconds;
  int done = 0;
  while (done == 0 && MPI_Wtime() < end) {
    require_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "anything");
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done != 0;
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
