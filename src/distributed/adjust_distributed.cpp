// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_equations.hpp"
#include "distributed/truss_output.hpp"
#include "distributed/truss_solver.hpp"
#include "geometry/index.hpp"
#include "trussmap/distributed.hpp"

#include <string>
#include <utility>

namespace trussmap {
using namespace distributed;

namespace {

struct Displacements {
  std::vector<double> x;  ///< of this process's landmarks, m
  std::vector<double> y;
};

Displacements own_displacements(const Placing& placing, Vec u) {
  Displacements result;
  const PetscScalar* values = nullptr;
  require_petsc(VecGetArrayRead(u, &values), "the solution");
  for (std::size_t k = 0; k < placing.own().size(); ++k) {
    result.x.push_back(values[2 * k]);
    result.y.push_back(values[2 * k + 1]);
  }
  require_petsc(VecRestoreArrayRead(u, &values), "the solution");
  return result;
}

/// Of all measurements, each counted by the process of its first landmark.
double chi2_of(const Communicator& all, const Placing& placing, const std::vector<ShareBar>& bars,
               const Displacements& u) {
  struct Moved {
    double x;
    double y;
  };
  const auto moved = [&](const std::int64_t& number) {
    return Moved{u.x[placing.local(number)], u.y[placing.local(number)]};
  };
  std::vector<std::int64_t> far;
  std::vector<int> whom;
  for (const ShareBar& bar : bars) {
    if (!placing.mine(bar.from) || placing.mine(bar.to)) continue;
    far.push_back(bar.to);
    whom.push_back(placing.owner(bar.to));
  }
  const std::vector<Moved> theirs = all.ask(far, whom, moved);
  auto next = theirs.begin();
  double chi2 = 0.0;
  for (const ShareBar& bar : bars) {
    if (!placing.mine(bar.from)) continue;
    const Moved from = moved(bar.from);
    const Moved to = placing.mine(bar.to) ? moved(bar.to) : *next++;
    const double ex = bar.off_x - (to.x - from.x);
    const double ey = bar.off_y - (to.y - from.y);
    chi2 += bar.xx * ex * ex + 2.0 * bar.xy * ex * ey + bar.yy * ey * ey;
  }
  return all.sum(chi2);
}

std::int64_t count_free(const Communicator& all, const Placing& placing) {
  std::int64_t count = 0;
  for (const PlacedLandmark& one : placing.own()) count += one.fixed == 1 ? 0 : 1;
  return all.sum(count);
}

void require_measurements(const TrussLines& lines, const Communicator& all,
                          const std::string& file) {
  all.agree(file, lines.fault);
  if (all.sum(static_cast<std::int64_t>(lines.routes.size())) == 0) {
    throw InputError(file, 0, "has no edges, expected EDGE_POINTXY lines");
  }
}

}  // namespace

DistributedAdjustment adjust_distributed(const Processes& /*processes*/,
                                         const std::filesystem::path& graph,
                                         const DistributedOptions& options) {
  const Communicator all;
  const PetscSession petsc;
  const std::string file = graph.string();
  DistributedAdjustment result;
  const double began = MPI_Wtime();
  TrussLines lines = parse_truss_lines(read_own_lines(all, graph), file);
  require_measurements(lines, all, file);
  result.routes = all.sum(static_cast<std::int64_t>(lines.routes.size()));
  Placing placing(all, lines, file);
  result.landmarks = placing.count();
  const std::vector<ShareBar> bars = share_bars(all, placing, lines.routes, file);
  lines = {};
  require_support(all, placing, bars);
  result.seconds_reading = MPI_Wtime() - began;

  Displacements u;
  {
    const TrussEquations equations = make_equations(all, placing, bars);
    tell_rigid_body_modes(all, placing, equations.K.get());
    const Solution solution = solve_equations(equations.K.get(), equations.f.get(), options);
    u = own_displacements(placing, solution.u.get());
    result.iterations = solution.iterations;
    result.residual = solution.residual;
    result.converged = solution.converged;
    result.complexity = solution.complexity;
    result.seconds_preparing = solution.seconds_preparing;
    result.seconds_solving = solution.seconds_solving;
  }
  result.chi2 = chi2_of(all, placing, bars, u);
  result.dof = 2 * (result.routes - count_free(all, placing));
  if (options.out.empty()) return result;
  const double solved = MPI_Wtime();
  for (std::size_t k = 0; k < u.x.size(); ++k) {
    u.x[k] += placing.own()[k].x;
    u.y[k] += placing.own()[k].y;
  }
  write_truss(all, placing, u.x, u.y, graph, options.out);
  result.seconds_writing = MPI_Wtime() - solved;
  return result;
}

}  // namespace trussmap
