// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_system.hpp"
#include "linalg/connected_parts.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <set>

namespace trussmap {
namespace {

bool in_map(const Measurement& one) {
  return is_in_map_frame(one.kind);
}

void refuse_loose_sessions(const RecordingProblem& problem) {
  const std::vector<int> untied = untied_poses(problem);
  if (untied.empty()) return;
  const bool absolute =
      std::any_of(problem.measurements.begin(), problem.measurements.end(), in_map);
  const std::string& session = problem.sessions[idx(problem.poses[idx(untied[0])].session)];
  throw SolveError(session + (absolute ? " floats" : " stands apart") +
                   ": no landmark ties it to " +
                   (absolute ? "the survey, the truth or the fixes" : problem.sessions.front()));
}

}  // namespace

std::vector<int> untied_poses(const RecordingProblem& problem, const std::vector<double>& weights) {
  const int map_frame = problem.nodes();  // a node of its own: what is measured in the map
  std::vector<NodePair> ties;
  bool absolute = false;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!weights.empty() && weights[k] == 0.0) continue;
    if (is_of_orientation(one.kind)) continue;
    absolute = absolute || in_map(one);
    if (one.to < 0 && !in_map(one)) continue;
    ties.push_back({one.from, in_map(one) ? map_frame : one.to});
  }
  std::vector<int> untied;
  if (problem.poses.empty()) return untied;
  const std::vector<int> parts = connected_parts(map_frame + 1, ties);
  const int home = parts[idx(absolute ? map_frame : problem.pose_node(0))];
  for (int pose = 0; pose < static_cast<int>(problem.poses.size()); ++pose) {
    if (parts[idx(problem.pose_node(pose))] != home) untied.push_back(pose);
  }
  return untied;
}

RecordingGauge choose_gauge(const RecordingProblem& problem) {
  refuse_loose_sessions(problem);
  bool position = false;
  bool direction = false;
  int fixes = 0;
  std::set<int> surveyed;
  for (const Measurement& one : problem.measurements) {
    switch (one.kind) {
      case MeasurementKind::survey:
        position = true;
        surveyed.insert(one.from);
        break;
      case MeasurementKind::survey_heading:
        direction = true;
        break;
      case MeasurementKind::truth:
        position = direction = true;
        break;
      case MeasurementKind::fix:
        position = true;
        ++fixes;
        break;
      case MeasurementKind::segment:
        direction = direction || one.rows == 4;
        break;
      default:
        break;
    }
  }
  direction = direction || surveyed.size() >= 2 || fixes >= 2 || (fixes > 0 && !surveyed.empty());
  const bool any_pose = !problem.poses.empty();
  const bool landmarks = problem.landmark_count() > 0;
  return {!position && landmarks, !direction && any_pose, !position && !landmarks && any_pose};
}

}  // namespace trussmap
