// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/dead_reckoned_horizons.hpp"

#include "fit/cleared_recording.hpp"
#include "recording/time_spans.hpp"
#include "validation/arrival_rise.hpp"
#include "validation/blocked_coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::validation {
namespace {

constexpr double kAnchored = 1.0;  // s from an end to a sighting

/// Times of a session's nodes, ascending.
std::vector<double> node_times(const fitting::FitState& fit, std::size_t session) {
  std::vector<double> times;
  for (const estimation::PoseNode& node : fit.problem.poses) {
    if (idx(node.session) == session) times.push_back(node.t);
  }
  return times;
}

bool is_anchored(const std::vector<double>& nodes, double t) {
  const auto after = std::lower_bound(nodes.begin(), nodes.end(), t - kAnchored);
  return after != nodes.end() && *after <= t + kAnchored;
}

/// From one pose of a path to a later one, in the axes of the first.
Vector2 driven(const MotionRows& drive, const fitting::SessionPath& path, double from, double to) {
  const Pose a = fitting::pose_at(drive, path, from);
  const Pose b = fitting::pose_at(drive, path, to);
  return rotation(-a.heading) * (b.position() - a.position());
}

/// The squared error at the end of one window, m^2.
struct WindowError {
  std::size_t session = 0;
  double t = 0.0;  ///< s, its start
  double squared = 0.0;
};

/// Times from the first node on, half a horizon apart, that have a node within reach: as many as
/// there are nodes, however long the clock ran.
std::vector<double> anchored_starts(const std::vector<double>& nodes, double horizon) {
  const double apart = 0.5 * horizon;
  std::vector<double> starts;
  double next = 0.0;
  for (const double node : nodes) {
    const double from = node - nodes.front();
    for (double k = std::max(next, std::ceil((from - kAnchored) / apart));
         k * apart <= from + kAnchored; k += 1.0) {
      starts.push_back(nodes.front() + k * apart);
      next = k + 1.0;
    }
  }
  return starts;
}

/// Those of a session whose middle is in a block, by a path that is reckoned with the coefficients
/// without it.
void add_windows(const fitting::FitState& judge, std::size_t session,
                 const std::vector<double>& nodes, const TimeBlocks& blocks, int block,
                 const fitting::SessionPath& reckoned, double horizon,
                 std::vector<WindowError>& windows) {
  const MotionRows& drive = judge.recordings[session].drive;
  for (const double t : anchored_starts(nodes, horizon)) {
    if (t + horizon > nodes.back()) break;
    if (blocks.at(static_cast<int>(session), t + 0.5 * horizon) != block) continue;
    if (!is_anchored(nodes, t + horizon)) continue;
    const auto& left_out = judge.used.left_out;
    if (!left_out.empty() && recording::overlaps_any({t, t + horizon}, left_out[session])) continue;
    const Vector2 off = driven(drive, reckoned, t, t + horizon) -
                        driven(drive, judge.paths[session], t, t + horizon);
    windows.push_back({session, t, off.squaredNorm()});
  }
}

/// Of the one fit's dead reckoning by the other's path; per horizon.
std::vector<std::vector<WindowError>> window_errors(const fitting::FitState& fit,
                                                    const fitting::FitState& judge,
                                                    const std::vector<double>& horizons) {
  constexpr int kBlocks = 5;
  const TimeBlocks blocks(judge.problem, kBlocks);
  const std::vector<Eigen::VectorXd> offsets = offsets_without_blocks(fit, blocks);
  std::vector<std::vector<WindowError>> windows(horizons.size());
  for (int block = 0; block < kBlocks; ++block) {
    const std::vector<fitting::ClearedRecording> clear = fitting::cleared(fit, offsets[idx(block)]);
    for (std::size_t s = 0; s < clear.size(); ++s) {
      const std::vector<double> nodes = node_times(judge, s);
      if (nodes.empty()) continue;
      const fitting::SessionPath reckoned = fitting::reckoned_path(clear[s], fit.model);
      for (std::size_t k = 0; k < horizons.size(); ++k) {
        add_windows(judge, s, nodes, blocks, block, reckoned, horizons[k], windows[k]);
      }
    }
  }
  return windows;
}

double mean_square(const std::vector<WindowError>& windows) {
  double sum = 0.0;
  for (const WindowError& one : windows) sum += one.squared;
  return windows.empty() ? 0.0 : sum / static_cast<double>(windows.size());
}

}  // namespace

std::vector<HorizonError> horizon_errors(const fitting::FitState& fit,
                                         const std::vector<double>& horizons) {
  std::vector<HorizonError> errors;
  errors.reserve(horizons.size());
  for (const std::vector<WindowError>& one : window_errors(fit, fit, horizons)) {
    errors.push_back({std::sqrt(mean_square(one)), static_cast<int>(one.size())});
  }
  return errors;
}

HorizonErrors horizon_errors(const fitting::FitState& fit) {
  const std::vector<HorizonError> errors = horizon_errors(fit, {10.0, 30.0});
  return {errors[0], errors[1]};
}

HorizonChange horizon_change(const fitting::FitState& before, const fitting::FitState& after,
                             double horizon) {
  constexpr std::size_t kTogether = 4;  // windows overlap by half, and errors last
  const auto in_time = [](const WindowError& a, const WindowError& b) {
    return std::pair(a.session, a.t) < std::pair(b.session, b.t);
  };
  std::vector<WindowError> first = window_errors(before, after, {horizon}).front();
  std::vector<WindowError> second = window_errors(after, after, {horizon}).front();
  std::sort(first.begin(), first.end(), in_time);
  std::sort(second.begin(), second.end(), in_time);
  HorizonChange change;
  change.windows = static_cast<int>(first.size());
  if (mean_square(first) > 0.0) {
    change.share = std::sqrt(mean_square(second) / mean_square(first));
  } else if (mean_square(second) > 0.0) {
    change.share = std::numeric_limits<double>::infinity();
  }
  std::vector<double> rises;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (k % kTogether == 0) rises.push_back(0.0);
    rises.back() += second[k].squared - first[k].squared;
  }
  change.rise_in_sds = sum_in_sds(rises);
  return change;
}

}  // namespace trussmap::validation
