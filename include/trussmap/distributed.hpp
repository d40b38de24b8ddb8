// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::distributed.
//
// Trusses that are too large for one machine: landmarks joined by measured displacements, adjusted
// by the processes that mpirun has started, each with a part of the file, of the map and of the
// equations (trussmap::distributed, MPI and PETSc; there only where it was configured with
// -D TRUSSMAP_WITH_MPI=ON).
//
//   minimise  chi2 = sum (p_j - p_i - z)' B (p_j - p_i - z)        fixed landmarks held
//
//   z    measured displacement from i to j                  m      map axes
//   B    its information, the inverse of its covariance     1/m^2
//   p    positions                                          m
//
// One linear system K u = f for the corrections u of the file's positions: the stiffness method
// (trussmap/truss.hpp). It is solved by conjugate gradients with smoothed-aggregation multigrid
// (Vanek, Mandel & Brezina 1996; PETSc's GAMG), which is given the rigid-body modes of the truss,
// or by a distributed Cholesky factor (MUMPS; Amestoy, Duff, L'Excellent & Koster 2001). Both are
// brought to their accuracy by corrections from the true residual f - K u.
//
// The file is g2o: VERTEX_XY, EDGE_POINTXY and FIX lines, every landmark with a VERTEX_XY line.
// Each process reads a range of its bytes; landmarks go to processes along a Hilbert curve through
// the positions, so that neighbours mostly share one. Results depend on the number of processes by
// rounding alone, and for a number of processes they are always the same.
#pragma once

#include "trussmap/error.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace trussmap {

/// The processes of this run. MPI begins with the object and ends with it: one in a program, and
/// none after it. All its calls, and adjust_distributed, are made by every process.
class Processes {
 public:
  Processes();
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  [[nodiscard]] int rank() const { return rank_; }    ///< of this process, from 0
  [[nodiscard]] int count() const { return count_; }  ///< of all
  /// At process 0 the text of each process, elsewhere none.
  [[nodiscard]] std::vector<std::string> gather(const std::string& text) const;
  /// The text of process 0.
  [[nodiscard]] std::string spread(const std::string& text) const;
  /// True if every process makes this call within so many seconds.
  [[nodiscard]] bool all_come(double seconds) const;
  /// Ends all processes at once: for what only one of them has noticed.
  [[noreturn]] void abort(int status) const;

 private:
  int rank_ = 0;
  int count_ = 1;
};

/// Whether this process is one of several that a launcher (mpirun, srun) has started for MPI.
[[nodiscard]] bool launched_together();

struct DistributedOptions {
  enum class Solver { multigrid, mumps };
  Solver solver = Solver::multigrid;
  /// |f - K u| to be reached, against |f|.
  double tolerance = 1e-12;
  int max_iterations = 2000;
  std::filesystem::path out;  ///< where not empty: the file with the positions found, as g2o
};

struct DistributedAdjustment {
  double chi2 = 0.0;  ///< of all measurements, at the positions found
  std::int64_t dof = 0;
  std::int64_t landmarks = 0;
  std::int64_t routes = 0;  ///< measurements
  int iterations = 0;       ///< of conjugate gradients; of the factor: solves
  double residual = 0.0;    ///< |f - K u| / |f|, 2-norms; 0 where f is 0
  bool converged = false;
  double complexity = 0.0;  ///< entries of all levels' operators against those of K; 0: no levels
  double seconds_reading = 0.0;
  double seconds_preparing = 0.0;  ///< levels or factor
  double seconds_solving = 0.0;
  double seconds_writing = 0.0;
};

/// Throws, in all processes alike, InputError on a file that is no such truss, SolveError where a
/// landmark is tied to no fixed one (without FIX: to the file's first) or the equations cannot be
/// solved.
[[nodiscard]] DistributedAdjustment adjust_distributed(const Processes& processes,
                                                       const std::filesystem::path& graph,
                                                       const DistributedOptions& options = {});

}  // namespace trussmap
