// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Three processes against one, on a truss small enough for both: positions of the serial frontal
// kernel to 1e-7 m, and one line for a mistake. Skipped by a build without MPI.
#include "json_file.hpp"
#include "scratch_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#ifdef TRUSSMAP_MPIEXEC
#include "distributed/hilbert.hpp"
#endif

namespace trussmap::distributed_test {
namespace {

using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

TEST(WithoutMpi, SolverPetscSaysHowToBuildIt) {
#ifdef TRUSSMAP_MPIEXEC
  GTEST_SKIP() << "needs a build without MPI";
#else
  const Ran ran = run_trussmap("adjust nothing.g2o --solver petsc");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.output.rfind("trussmap: --solver petsc is not in this build", 0), 0U) << ran.output;
  EXPECT_NE(ran.output.find("-D TRUSSMAP_WITH_MPI=ON"), std::string::npos);
  EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1);
#endif
}

#ifndef TRUSSMAP_MPIEXEC

TEST(Distributed, ThreeProcesses) {
  GTEST_SKIP() << "needs a build with MPI (cmake -D TRUSSMAP_WITH_MPI=ON)";
}

#else

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The command on so many processes.
Ran run_on(int processes, const std::string& arguments) {
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  ::setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  ::setenv("OMPI_MCA_mpi_yield_when_idle", "1", 1);
  ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
  Ran ran;
  FILE* pipe = ::popen(fmt::format("{} -n {} {} {} 2>&1", TRUSSMAP_MPIEXEC, processes,
                                   testing::command_path(), arguments)
                           .c_str(),
                       "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    ran.output.append(buffer.data(), count);
  }
  ran.status = WEXITSTATUS(::pclose(pipe));
  return ran;
}

/// A grid whose ids say nothing, with a few routes driven twice; lines end in any way.
std::string grid(int side, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<std::int64_t> ids(static_cast<std::size_t>(side * side));
  for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = 1000 - 7 * static_cast<std::int64_t>(k);
  std::shuffle(ids.begin(), ids.end(), random);
  const auto id = [&](int x, int y) { return ids[static_cast<std::size_t>(y * side + x)]; };
  std::string vertices = "# a grid\n\n";
  std::vector<std::string> edges;
  const auto measure = [&](std::int64_t from, std::int64_t to, double x, double y) {
    edges.push_back(fmt::format("EDGE_POINTXY {} {} {} {} 16 {} 44\n", from, to,
                                x + 0.2 * normal(random), y + 0.2 * normal(random),
                                3.0 * std::tanh(normal(random))));
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      vertices += fmt::format("VERTEX_XY {} {} {}{}\n", id(x, y), 5.0 * x + normal(random),
                              5.0 * y + normal(random), x % 3 == 0 ? "\r" : "");
      for (int again = 0; again <= (x == y ? 1 : 0); ++again) {
        if (x + 1 < side) measure(id(x, y), id(x + 1, y), 5.0, 0.0);
        if (y + 1 < side) measure(id(x, y + 1), id(x, y), 0.0, -5.0);
      }
    }
  }
  std::shuffle(edges.begin(), edges.end(), random);
  for (const std::string& edge : edges) vertices += edge;
  return vertices;
}

std::map<std::string, std::array<double, 2>> positions_in(const std::string& text) {
  std::map<std::string, std::array<double, 2>> found;
  std::istringstream lines(text);
  std::string tag;
  std::string id;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::array<double, 2> at{};
    if (words >> tag >> id >> at[0] >> at[1] && tag == "VERTEX_XY") found[id] = at;
  }
  return found;
}

std::string without_positions(const std::string& text) {
  std::string rest;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("VERTEX", 0) != 0) rest += line + '\n';
  }
  return rest;
}

double farthest(const std::string& a, const std::string& b) {
  const auto here = positions_in(a);
  const auto there = positions_in(b);
  EXPECT_EQ(here.size(), there.size());
  double most = 0.0;
  for (const auto& [id, at] : here) {
    const auto& other = there.at(id);
    most = std::max({most, std::abs(at[0] - other[0]), std::abs(at[1] - other[1])});
  }
  return most;
}

TEST(Distributed, PositionsAreTheSerialKernels) {
  const ScratchFolder scratch;
  const auto path = [&](const std::string& name) { return (scratch.path() / name).string(); };
  for (const std::string fixed : {"", "FIX 300\n"}) {
    std::ofstream(path("grid.g2o"), std::ios::binary) << grid(24, 7) << fixed;
    const Ran serial = run_trussmap(fmt::format("adjust {} --out {} --json {}", path("grid.g2o"),
                                                path("serial.g2o"), path("serial.json")));
    ASSERT_EQ(serial.status, 0) << serial.output;
    const std::string expected = content_of(path("serial.g2o"));
    for (const auto& [processes, solver] :
         std::vector<std::pair<int, std::string>>{{1, "petsc"}, {3, "petsc"}, {3, "mumps"}}) {
      const std::string how = fmt::format("adjust {} --solver {} --out {} --json {}",
                                          path("grid.g2o"), solver, path("out.g2o"), path("j"));
      const Ran ran = run_on(processes, how);
      ASSERT_EQ(ran.status, 0) << ran.output;
      const std::string found = content_of(path("out.g2o"));
      EXPECT_LE(farthest(found, expected), 1e-7) << how;
      EXPECT_TRUE(without_positions(found) == without_positions(expected)) << how;
      const auto ours = testing::read_json(path("j"));
      const auto theirs = testing::read_json(path("serial.json"));
      EXPECT_NEAR(ours["chi2"], theirs["chi2"], 1e-8 * theirs["chi2"].get<double>());
      EXPECT_EQ(ours["dof"], theirs["dof"]);
      if (solver == "mumps") continue;  // its last digits follow the arrival of messages
      ASSERT_EQ(run_on(processes, how).status, 0);
      EXPECT_TRUE(content_of(path("out.g2o")) == found) << "not the same again: " << how;
    }
  }
}

TEST(Distributed, MistakesAreOneLine) {
  const ScratchFolder scratch;
  const auto path = [&](const std::string& name) { return (scratch.path() / name).string(); };
  const std::string good = grid(6, 3);
  const std::size_t last = static_cast<std::size_t>(std::count(good.begin(), good.end(), '\n')) + 1;
  struct Case {
    std::string added;
    int status;
    std::string said;
  };
  const std::vector<Case> cases{
      {"VERTEX_XY 1000 0 0\n", 2, fmt::format(":{}: vertex 1000 is defined a second time", last)},
      {"EDGE_POINTXY 1000 5 1 1 1 0 1\n", 2, fmt::format(":{}: vertex 5 has no VERTEX line", last)},
      {"EDGE_POINTXY 1000 993 1 x 1 0 1\n", 2, fmt::format(":{}: dy is \"x\"", last)},
      {"VERTEX_SE2 5 0 0 0\n", 2, fmt::format(":{}: \"VERTEX_SE2\" is no line of a truss", last)},
      {"FIX 5\n", 2, fmt::format(":{}: vertex 5 is fixed but has no VERTEX line", last)},
      {"VERTEX_XY 5 0 0\n", 1, "vertex 5 is tied to nothing that is held"}};
  for (const Case& one : cases) {
    std::ofstream(path("bad.g2o"), std::ios::binary) << good << one.added;
    const Ran ran = run_on(
        3, fmt::format("adjust {} --solver petsc --out {}", path("bad.g2o"), path("out.g2o")));
    EXPECT_EQ(ran.status, one.status) << ran.output;
    EXPECT_NE(ran.output.find(one.said), std::string::npos) << ran.output;
    std::size_t said = 0;
    for (std::size_t at = ran.output.find("trussmap: "); at != std::string::npos;
         at = ran.output.find("trussmap: ", at + 1)) {
      ++said;
    }
    EXPECT_EQ(said, 1U) << ran.output;
    EXPECT_FALSE(std::filesystem::exists(path("out.g2o")));
  }
}

TEST(Distributed, ToursOfThreeProcessesAreThoseOfOne) {
  const std::string tour = "tour --mesh 3x3 --tours 2 --seeds 7";
  const Ran one = run_trussmap(tour);
  const Ran three = run_on(3, tour);
  EXPECT_EQ(three.status, 0) << three.output;
  EXPECT_EQ(three.output, one.output);
}

TEST(Distributed, HilbertsCurveGoesFromCellToNeighbour) {
  constexpr std::uint32_t kSide = 32;
  constexpr std::uint32_t kCell = (std::uint32_t{1} << distributed::kHilbertBits) / kSide;
  std::map<std::uint64_t, std::array<int, 2>> cells;
  for (std::uint32_t x = 0; x < kSide; ++x) {
    for (std::uint32_t y = 0; y < kSide; ++y) {
      // Of a cell's places the curve's first, so that cells are in order.
      const std::uint64_t place = distributed::hilbert_place(x * kCell, y * kCell) / kCell / kCell;
      cells[place] = {static_cast<int>(x), static_cast<int>(y)};
    }
  }
  ASSERT_EQ(cells.size(), kSide * kSide);
  EXPECT_EQ(cells.rbegin()->first, kSide * kSide - 1);
  for (auto at = std::next(cells.begin()); at != cells.end(); ++at) {
    const auto& before = std::prev(at)->second;
    EXPECT_EQ(std::abs(at->second[0] - before[0]) + std::abs(at->second[1] - before[1]), 1);
  }
}

#endif

}  // namespace
}  // namespace trussmap::distributed_test
