// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A build without MPI.
#include "team.hpp"

namespace trussmap::app {

bool built_with_mpi() {
  return false;
}

int Team::rank() const {
  return 0;
}

int Team::count() const {
  return 1;
}

std::vector<std::string> Team::gather(const std::string& text) const {
  return {text};
}

bool run_together(bool /*always*/, const std::function<void(const Team&)>& work) {
  work(Team(nullptr));
  return true;
}

}  // namespace trussmap::app
