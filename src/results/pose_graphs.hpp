// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What adjust writes.
#pragma once

#include "results/described.hpp"
#include "trussmap/distributed.hpp"
#include "trussmap/pose_graph.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::results {

/// What adjust says.
struct AdjustReport {
  PoseGraphAdjustment result;
  int poses = 0;
  int landmarks = 0;
  std::size_t edges = 0;
  std::optional<std::vector<std::pair<int, int>>> left_out;  ///< edges, by ids; none: not asked
  double seconds = 0.0;
};
template <auto kMember>
inline constexpr auto kAdjusted = through(&AdjustReport::result, kMember);

template <>
inline constexpr auto kDescribed<AdjustReport> = described(
    field("chi2", kAdjusted<&PoseGraphAdjustment::chi2>, "sum of e' Omega e as g2o defines it"),
    field("dof", kAdjusted<&PoseGraphAdjustment::dof>, "degrees of freedom"),
    field("iterations", kAdjusted<&PoseGraphAdjustment::iterations>).at_least(0.0),
    field("gradient_norm", kAdjusted<&PoseGraphAdjustment::gradient_norm>, "at the end"),
    field("poses", &AdjustReport::poses, "vertices VERTEX_SE2").at_least(0.0),
    field("landmarks", &AdjustReport::landmarks, "vertices VERTEX_XY").at_least(0.0),
    field("edges", &AdjustReport::edges),
    field("converged", kAdjusted<&PoseGraphAdjustment::converged>, "whether a minimum was reached"),
    field("start", kAdjusted<&PoseGraphAdjustment::start>,
          "what was started from: file, odometry or what best found"),
    field("seconds", &AdjustReport::seconds, "of the adjustment"),
    field("warnings", kAdjusted<&PoseGraphAdjustment::warnings>),
    field("left_out", &AdjustReport::left_out, "with --robust: edges, by their vertices' ids")
        .if_any());

/// What adjust --solver says.
struct DistributedReport {
  DistributedAdjustment result;
  std::string solver;
  int processes = 0;
};
template <auto kMember>
inline constexpr auto kDistributed = through(&DistributedReport::result, kMember);

template <>
inline constexpr auto kDescribed<DistributedReport> = described(
    field("chi2", kDistributed<&DistributedAdjustment::chi2>, "of the linear problem"),
    field("dof", kDistributed<&DistributedAdjustment::dof>, "degrees of freedom"),
    field("iterations", kDistributed<&DistributedAdjustment::iterations>, "of the solver")
        .at_least(0.0),
    field("residual", kDistributed<&DistributedAdjustment::residual>, "relative, at the end"),
    field("landmarks", kDistributed<&DistributedAdjustment::landmarks>).at_least(0.0),
    field("edges", kDistributed<&DistributedAdjustment::routes>).at_least(0.0),
    field("converged", kDistributed<&DistributedAdjustment::converged>, "to the tolerance"),
    field("solver", &DistributedReport::solver, "petsc or mumps"),
    field("processes", &DistributedReport::processes, "MPI's").at_least(0.0),
    field("complexity", kDistributed<&DistributedAdjustment::complexity>,
          "entries of all multigrid levels over those of the matrix; 0: no multigrid"),
    field("seconds",
          described(field("reading", kDistributed<&DistributedAdjustment::seconds_reading>, "s"),
                    field("preparing", kDistributed<&DistributedAdjustment::seconds_preparing>,
                          "s"),
                    field("solving", kDistributed<&DistributedAdjustment::seconds_solving>, "s"),
                    field("writing", kDistributed<&DistributedAdjustment::seconds_writing>, "s"))));

}  // namespace trussmap::results
