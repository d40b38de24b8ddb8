// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/dead_reckoned_horizons.hpp"

#include "fit/cleared_recording.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

constexpr double kAnchored = 1.0;  // s from an end to a sighting

/// Times of a session's nodes, ascending.
std::vector<double> node_times(const FitState& fit, std::size_t session) {
  std::vector<double> times;
  for (const PoseNode& node : fit.problem.poses) {
    if (idx(node.session) == session) times.push_back(node.t);
  }
  return times;
}

bool is_anchored(const std::vector<double>& nodes, double t) {
  const auto after = std::lower_bound(nodes.begin(), nodes.end(), t - kAnchored);
  return after != nodes.end() && *after <= t + kAnchored;
}

/// From one pose of a path to a later one, in the axes of the first.
Vector2 driven(const Drive& drive, const SessionPath& path, double from, double to) {
  const Pose a = pose_at(drive, path, from);
  const Pose b = pose_at(drive, path, to);
  return rotation(-a.heading) * (b.position() - a.position());
}

}  // namespace

HorizonError horizon_error(const FitState& fit, double horizon) {
  HorizonError result;
  const std::vector<ClearedRecording> clear = cleared(fit);
  double sum = 0.0;
  for (std::size_t s = 0; s < clear.size(); ++s) {
    const Drive& drive = fit.recordings[s].drive;
    const std::vector<double> nodes = node_times(fit, s);
    if (nodes.empty()) continue;
    const SessionPath reckoned = reckoned_path(clear[s], fit.model);
    for (double t = nodes.front(); t + horizon <= nodes.back(); t += 0.5 * horizon) {
      if (!is_anchored(nodes, t) || !is_anchored(nodes, t + horizon)) continue;
      const Vector2 off =
          driven(drive, reckoned, t, t + horizon) - driven(drive, fit.paths[s], t, t + horizon);
      sum += off.squaredNorm();
      ++result.windows;
    }
  }
  if (result.windows > 0) result.rms = std::sqrt(sum / result.windows);
  return result;
}

}  // namespace trussmap
