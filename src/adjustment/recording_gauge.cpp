// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/adjustment/recording_system.hpp"
#include "trussmap/core/error.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <fmt/format.h>

namespace trussmap {
namespace {

int root_of(std::vector<int>& parent, int node) {
  while (parent[idx(node)] != node) {
    parent[idx(node)] = parent[idx(parent[idx(node)])];
    node = parent[idx(node)];
  }
  return node;
}

/// Sessions that no common landmark, survey or truth ties to the first.
void refuse_loose_sessions(const RecordingProblem& problem) {
  const int map_frame = problem.nodes();  // a node of its own: what is measured in the map
  std::vector<int> parent(idx(problem.nodes()) + 1);
  std::iota(parent.begin(), parent.end(), 0);
  bool absolute = false;
  for (const Measurement& one : problem.measurements) {
    const bool in_map = one.kind == MeasurementKind::survey || one.kind == MeasurementKind::truth;
    absolute = absolute || in_map;
    if (one.to < 0 && !in_map) continue;
    parent[idx(root_of(parent, one.from))] = root_of(parent, in_map ? map_frame : one.to);
  }
  if (problem.poses.empty()) return;
  const int home = root_of(parent, absolute ? map_frame : problem.pose_node(0));
  for (std::size_t pose = 0; pose < problem.poses.size(); ++pose) {
    if (root_of(parent, problem.pose_node(static_cast<int>(pose))) == home) continue;
    const std::string& session = problem.sessions[idx(problem.poses[pose].session)];
    throw SolveError(fmt::format("{} {}: no landmark ties it to {}", session,
                                 absolute ? "floats" : "stands apart",
                                 absolute ? "the survey or the truth" : problem.sessions.front()));
  }
}

}  // namespace

RecordingGauge choose_gauge(const RecordingProblem& problem) {
  refuse_loose_sessions(problem);
  bool position = false;
  bool direction = false;
  std::set<int> surveyed;
  for (const Measurement& one : problem.measurements) {
    switch (one.kind) {
      case MeasurementKind::survey:
        position = true;
        surveyed.insert(one.from);
        break;
      case MeasurementKind::truth:
        position = direction = true;
        break;
      case MeasurementKind::piece:
        direction = direction || one.rows == 4;
        break;
      default:
        break;
    }
  }
  direction = direction || surveyed.size() >= 2;
  return {!position && problem.landmark_count() > 0, !direction && !problem.poses.empty()};
}

}  // namespace trussmap
