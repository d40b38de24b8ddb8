// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/dead_reckoned_horizons.hpp"

#include "fit/cleared_recording.hpp"
#include "recording/time_spans.hpp"
#include "validation/blocked_coefficients.hpp"

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

/// Squared errors over one horizon, window by window.
class Windows {
 public:
  explicit Windows(double horizon) : horizon_(horizon) {}

  /// Those of a session whose middle is in a block, reckoned with the coefficients without it.
  void add(const FitState& fit, std::size_t session, const std::vector<double>& nodes,
           const TimeBlocks& blocks, int block, const SessionPath& reckoned) {
    const Drive& drive = fit.recordings[session].drive;
    for (double t = nodes.front(); t + horizon_ <= nodes.back(); t += 0.5 * horizon_) {
      if (blocks.at(static_cast<int>(session), t + 0.5 * horizon_) != block) continue;
      if (!is_anchored(nodes, t) || !is_anchored(nodes, t + horizon_)) continue;
      const auto& left_out = fit.used.left_out;
      if (!left_out.empty() && overlaps_any({t, t + horizon_}, left_out[session])) continue;
      const Vector2 off = driven(drive, reckoned, t, t + horizon_) -
                          driven(drive, fit.paths[session], t, t + horizon_);
      sum_ += off.squaredNorm();
      ++windows_;
    }
  }

  [[nodiscard]] HorizonError error() const {
    return {windows_ > 0 ? std::sqrt(sum_ / windows_) : 0.0, windows_};
  }

 private:
  double horizon_;
  double sum_ = 0.0;
  int windows_ = 0;
};

}  // namespace

std::vector<HorizonError> horizon_errors(const FitState& fit, const std::vector<double>& horizons) {
  constexpr int kBlocks = 5;
  const TimeBlocks blocks(fit.problem, kBlocks);
  const std::vector<Eigen::VectorXd> offsets = offsets_without_blocks(fit, blocks);
  std::vector<Windows> windows(horizons.begin(), horizons.end());
  for (int block = 0; block < kBlocks; ++block) {
    const std::vector<ClearedRecording> clear = cleared(fit, offsets[idx(block)]);
    for (std::size_t s = 0; s < clear.size(); ++s) {
      const std::vector<double> nodes = node_times(fit, s);
      if (nodes.empty()) continue;
      const SessionPath reckoned = reckoned_path(clear[s], fit.model);
      for (Windows& one : windows) one.add(fit, s, nodes, blocks, block, reckoned);
    }
  }
  std::vector<HorizonError> errors;
  errors.reserve(windows.size());
  for (const Windows& one : windows) errors.push_back(one.error());
  return errors;
}

HorizonErrors horizon_errors(const FitState& fit) {
  const std::vector<HorizonError> errors = horizon_errors(fit, {10.0, 30.0});
  return {errors[0], errors[1]};
}

}  // namespace trussmap
