// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/built_path.hpp"

#include "estimation/measurement_rows.hpp"
#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::map_building {
namespace {

std::vector<Vector2> places_of(const fitting::SessionPath& path) {
  std::vector<Vector2> places{path.start.position()};
  places.reserve(path.ends.size() + 1);
  for (const Pose& one : path.ends) places.push_back(one.position());
  return places;
}

double dispersion_of(const fitting::FitState& fit) {
  return fit.adjustment.chi2 / std::max(1, fit.adjustment.dof);
}

PathTie tie_of(const fitting::FitState& fit, const estimation::Measurement& one) {
  const auto pose = [&fit](int node) { return idx(node - fit.problem.landmark_count()); };
  const effects::ViewPattern view =
      estimation::view_of(fit.columns.border, fitting::offsets_of(fit), one);
  const Vector2 error =
      estimation::measurement_rows(fit.problem, one, fit.adjustment.state, one.value, view)
          .error.head<2>();
  PathTie tie;
  tie.loop = estimation::is_tie(one);
  tie.t = fit.problem.time_of(one.from);
  tie.misfit = error.norm();
  if (tie.loop) {
    tie.t2 = fit.problem.time_of(one.to);
    tie.from = fit.adjustment.state.poses[pose(one.from)].position();
    tie.to = fit.adjustment.state.poses[pose(one.to)].position();
  } else {
    tie.from = one.value.head<2>();
    tie.to = tie.from + error;
  }
  return tie;
}

/// Fixes and loops that were used, and those that were left out.
void add_ties(const fitting::FitState& fit, std::vector<BuiltPath>& paths) {
  std::size_t next = 0;  // of left_out, which ascends
  const std::vector<int>& left_out = fit.adjustment.left_out;
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const estimation::Measurement& one = fit.problem.measurements[k];
    const bool out = next < left_out.size() && idx(left_out[next]) == k;
    if (out) ++next;
    if (!estimation::is_tie(one) && !estimation::is_position(one)) continue;
    PathTie tie = tie_of(fit, one);
    tie.left_out = out;
    paths[idx(one.session)].ties.push_back(tie);
  }
  for (BuiltPath& path : paths) {
    std::stable_sort(path.ties.begin(), path.ties.end(), [](const PathTie& a, const PathTie& b) {
      return a.loop != b.loop ? b.loop : a.t < b.t;
    });
  }
}

void add_standard_errors(const fitting::FitState& fit, std::vector<BuiltPath>& paths) {
  const std::vector<Matrix3> covariances =
      estimation::pose_covariances(fit.problem, fit.columns.border, fit.adjustment);
  const double scale = std::max(1.0, dispersion_of(fit));
  std::vector<std::vector<double>> sds(paths.size());
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    const estimation::PoseNode& node = fit.problem.poses[k];
    BuiltPath& path = paths[idx(node.session)];
    const double sd = std::sqrt(scale * covariances[k].topLeftCorner<2, 2>().trace());
    sds[idx(node.session)].push_back(sd);
    if (sd < path.worst_sd) continue;
    path.worst_sd = sd;
    path.worst_t = node.t;
  }
  for (std::size_t s = 0; s < paths.size(); ++s)
    paths[s].median_sd = statistics::median(std::move(sds[s]));
}

std::optional<PathOnTruth> laid_on_truth(const DrivenRecording& recording,
                                         const fitting::SessionPath& adjusted,
                                         const fitting::SessionPath& reckoned) {
  constexpr std::size_t kFewest = 3;
  const MotionRows& drive = recording.drive;
  std::vector<Vector2> truth, path, dead;
  for (const TruthRow& row : recording.truth) {
    if (row.t < drive.start() || row.t > drive.t.back()) continue;
    truth.emplace_back(row.x, row.y);
    path.push_back(fitting::pose_at(drive, adjusted, row.t).position());
    dead.push_back(fitting::pose_at(drive, reckoned, row.t).position());
  }
  if (truth.size() < kFewest) return std::nullopt;
  return PathOnTruth{static_cast<int>(truth.size()), align_rigidly(path, truth).rms,
                     align_rigidly(dead, truth).rms};
}

}  // namespace

std::vector<BuiltPath> paths_of(const MapFitState& best,
                                const std::vector<DrivenRecording>& recordings,
                                const std::vector<fitting::ClearedRecording>& believed,
                                const Model& model) {
  std::vector<BuiltPath> paths(recordings.size());
  for (std::size_t s = 0; s < paths.size(); ++s) {
    BuiltPath& path = paths[s];
    const fitting::SessionPath reckoned = fitting::reckoned_path(believed[s], model);
    path.recording = recordings[s].name;
    path.adjusted = places_of(best.fit.paths[s]);
    path.dead_reckoned = places_of(reckoned);
    const Alignment laid = align_rigidly(path.dead_reckoned, path.adjusted);
    path.rms_dead_reckoning = laid.rms;
    for (Vector2& one : path.dead_reckoned) one = laid.apply(one);
    for (std::size_t k = 1; k < path.adjusted.size(); ++k) {
      path.length += (path.adjusted[k] - path.adjusted[k - 1]).norm();
    }
    path.on_truth = laid_on_truth(recordings[s], best.fit.paths[s], reckoned);
  }
  add_ties(best.fit, paths);
  add_standard_errors(best.fit, paths);
  return paths;
}

MapQuality quality_of(const std::vector<BuiltPath>& paths, const MapFitState& best) {
  MapQuality result;
  result.dispersion = dispersion_of(best.fit);
  std::vector<double> medians;
  std::ptrdiff_t ties = 0;
  std::ptrdiff_t lost = 0;
  for (const BuiltPath& path : paths) {
    medians.push_back(path.median_sd);
    result.worst_sd = std::max(result.worst_sd, path.worst_sd);
    ties += std::ssize(path.ties);
    lost += std::count_if(path.ties.begin(), path.ties.end(),
                          [](const PathTie& one) { return one.left_out; });
  }
  result.median_sd = statistics::median(std::move(medians));
  result.left_out_share =
      static_cast<double>(lost) / static_cast<double>(std::max<std::ptrdiff_t>(1, ties));
  return result;
}

}  // namespace trussmap::map_building
