// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Speed and scale, as ratios measured in one run: see README.md beside this file.
#include "scale/ceres_rivals.hpp"
#include "scale/measure.hpp"
#include "scale/parts.hpp"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <cholmod.h>
#include <fmt/format.h>

// What OpenBLAS says of itself, if that is the BLAS.
extern "C" __attribute__((weak)) char* openblas_get_config();

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

void print_heading() {
  const std::time_t now = std::time(nullptr);
  char date[32] = "";
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
  fmt::print("{}; {}, {} processors\n", date, processor(), sysconf(_SC_NPROCESSORS_ONLN));
  const std::string ceres = trussmap::bench::ceres_version();
  fmt::print("g++ {}, Eigen {}.{}.{}, CHOLMOD {}.{}.{}, Ceres {}, BLAS: {}\n", __VERSION__,
             EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, CHOLMOD_MAIN_VERSION,
             CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION, ceres.empty() ? "not there" : ceres,
             openblas_get_config != nullptr ? openblas_get_config() : "not OpenBLAS");
  double loads[1] = {};
  if (getloadavg(loads, 1) == 1) fmt::print("load of the machine at the start: {:.1f}\n", loads[0]);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  // One thread for everybody. BLAS and OpenMP read this when they are loaded, so the program starts
  // anew. (A pool of threads would not outlive the forks either.)
  if (std::getenv("TRUSSMAP_ONE_THREAD") == nullptr) {
    for (const char* name : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "TRUSSMAP_ONE_THREAD"}) {
      setenv(name, "1", 1);
    }
    execv("/proc/self/exe", argv);
  }
  CLI::App app("Speed and scale of trussmap beside CHOLMOD and Ceres");
  std::vector<std::string> parts{"grid",       "covariances", "refinement",
                                 "increments", "nonlinear",   "input"};
  app.add_option("parts", parts, "which parts")->check(CLI::IsMember(parts));
  std::vector<int> sides{30, 100, 300, 1000};
  app.add_option("--sides", sides, "of the grids")->capture_default_str();
  std::vector<int> landmarks{1000, 10000, 100000, 1000000};
  app.add_option("--landmarks", landmarks, "of the maps to refine")->capture_default_str();
  int corrections = 2000;
  app.add_option("--corrections", corrections, "refinements per map")->capture_default_str();
  std::string graphs;
  app.add_option("--graphs", graphs, "folder with the pose graphs (none: that part is left out)");
  int repetitions = 5;
  app.add_option("--repetitions", repetitions, "rounds of all rivals")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  print_heading();
  const bool has_ceres = !ceres_version().empty();
  for (const std::string& part : parts) {
    if (part == "grid") grid_part(sides, repetitions, has_ceres);
    if (part == "covariances") covariances_part(sides, repetitions);
    if (part == "refinement") refinement_part(landmarks, corrections);
    if (part == "increments") increments_part(100);
    if (part == "nonlinear" && has_ceres && !graphs.empty()) nonlinear_part(graphs, repetitions);
    if (part == "input") input_part(500000, repetitions);
  }
  return 0;
}
