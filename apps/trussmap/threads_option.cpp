// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "threads_option.hpp"

#include "trussmap/running.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>

// Of OpenBLAS, where it is the BLAS in use.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));

namespace trussmap::app {
namespace {

constexpr int kMostThreads = 1024;

/// By mpirun (Open MPI, MPICH, SLURM), which has a process for every processor.
bool is_one_of_many_processes() {
  const std::array names{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
  return std::any_of(names.begin(), names.end(), [](const char* name) {
    const char* size = std::getenv(name);
    return size != nullptr && std::atoi(size) > 1;
  });
}

}  // namespace

void add_threads_option(CLI::App& app) {
  // The library's threads each call BLAS: threads of its own would only be in their way.
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  set_threads(is_one_of_many_processes() ? 1 : available_threads());
  const std::function<void(const int&)> set = [](const int& threads) { set_threads(threads); };
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    command
        ->add_option_function("--threads", set,
                              "Work on so many threads; if left out on as many as there are "
                              "processors, under mpirun on one. Figures do not depend on it")
        ->check(CLI::Range(1, kMostThreads))
        ->type_name("N")
        ->group("Limits");
  }
}

}  // namespace trussmap::app
