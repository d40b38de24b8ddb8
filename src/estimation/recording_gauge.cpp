// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_system.hpp"
#include "linalg/connected_parts.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <set>

namespace trussmap::estimation {
namespace {

void refuse_loose_sessions(const RecordingProblem& problem) {
  const std::vector<int> untied = untied_poses(problem);
  if (untied.empty()) return;
  const bool absolute =
      std::any_of(problem.measurements.begin(), problem.measurements.end(), is_in_map_frame);
  const std::string& session = problem.sessions[idx(problem.poses[idx(untied[0])].session)];
  throw SolveError(session + (absolute ? " floats" : " stands apart") +
                   ": no landmark ties it to " +
                   (absolute ? "the survey, the truth or the fixes" : problem.sessions.front()));
}

}  // namespace

std::vector<int> untied_poses(const RecordingProblem& problem, const std::vector<double>& weights) {
  const int map_frame = problem.nodes();  // a node of its own: what is measured in the map
  std::vector<linalg::NodePair> ties;
  bool absolute = false;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!weights.empty() && weights[k] == 0.0) continue;
    if (is_of_orientation(one)) continue;
    absolute = absolute || is_in_map_frame(one);
    if (one.to < 0 && !is_in_map_frame(one)) continue;
    ties.push_back({one.from, is_in_map_frame(one) ? map_frame : one.to});
  }
  std::vector<int> untied;
  if (problem.poses.empty()) return untied;
  const std::vector<int> parts = linalg::connected_parts(map_frame + 1, ties);
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
  std::set<int> places;  // nodes
  for (const Measurement& one : problem.measurements) {
    position = position || is_in_map_frame(one);
    if (is_in_map_frame(one)) places.insert(one.from);
    direction = direction || tells_heading(one) || reads_compass(one);
  }
  direction = direction || places.size() >= 2;
  const bool any_pose = !problem.poses.empty();
  const bool landmarks = problem.landmark_count() > 0;
  return {!position && landmarks, !direction && any_pose, !position && !landmarks && any_pose};
}

}  // namespace trussmap::estimation
