// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/session_instants.hpp"

#include "drive/legs.hpp"
#include "estimation/motion_changes.hpp"
#include "recording/time_spans.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {
namespace {

std::vector<std::size_t> truth_rows_used(const DrivenRecording& recording,
                                         const ProblemOptions& options) {
  std::vector<std::size_t> used;
  if (!options.truth || recording.truth.empty()) return used;
  const MotionRows& drive = recording.drive;
  double path = 0.0;
  double turn = 0.0;
  double from = drive.start();
  std::size_t last = 0;
  for (std::size_t k = 0; k < recording.truth.size(); ++k) {
    const double t = recording.truth[k].t;
    if (t < drive.start() || t > drive.t.back()) continue;
    for (const SegmentRow& row : segment_rows(drive, from, t)) {
      path += std::abs(row.path);
      turn += std::abs(row.turn);
    }
    from = t;
    last = k;
    if (used.empty() || path >= options.truth_path || turn >= options.truth_turn) {
      used.push_back(k);
      path = turn = 0.0;
    }
  }
  // At rest again, the end tells a late clock from a short way.
  if (!used.empty() && used.back() != last) used.push_back(last);
  return used;
}

/// All but those that follow one another faster than their errors change; at rest one in
/// `fix_gap`, too, for each tells more of the place.
std::vector<std::size_t> fixes_used(const DrivenRecording& recording,
                                    const ProblemOptions& options) {
  std::vector<std::size_t> used;
  if (!options.fixes || recording.fixes.empty()) return used;
  const MotionRows& drive = recording.drive;
  const std::vector<double> driven = drive::driven_path(drive);
  double last_t = 0.0;
  double last_path = 0.0;
  for (std::size_t k = 0; k < recording.fixes.size(); ++k) {
    const double t = recording.fixes[k].t;
    if (t < drive.start() || t > drive.t.back()) continue;
    const double path = drive::path_at(drive, driven, t);
    const bool soon = t - last_t < options.fix_gap && path - last_path < options.fix_path;
    if (!used.empty() && soon) continue;
    used.push_back(k);
    last_t = t;
    last_path = path;
  }
  return used;
}

/// Ascending.
std::vector<double> times_measured(const DrivenRecording& recording, const RowsUsed& used) {
  std::vector<double> times;
  for (const Sighting& sighting : recording.sightings) times.push_back(sighting.t);
  for (const std::size_t k : used.truth) times.push_back(recording.truth[k].t);
  for (const std::size_t k : used.fixes) times.push_back(recording.fixes[k].t);
  for (std::size_t k = 0; used.loops && k < recording.loops.size(); ++k) {
    times.push_back(recording.loops[k].t);
    times.push_back(recording.loops[k].t2);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Drops instants inside what is left out, and those that would stand alone.
std::vector<double> outside(std::vector<double> times, const std::vector<TimeSpan>& left_out) {
  if (left_out.empty()) return times;
  std::erase_if(times, [&left_out](double t) {
    return std::any_of(left_out.begin(), left_out.end(),
                       [t](const TimeSpan& span) { return span.from < t && t < span.to; });
  });
  const auto drives = [&](std::size_t from) {
    return from + 1 < times.size() &&
           !recording::overlaps_any({times[from], times[from + 1]}, left_out);
  };
  std::vector<double> kept;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if ((k > 0 && drives(k - 1)) || drives(k)) kept.push_back(times[k]);
  }
  return kept;
}

}  // namespace

RowsUsed rows_used(const DrivenRecording& recording, const ProblemOptions& options) {
  RowsUsed used{truth_rows_used(recording, options), fixes_used(recording, options),
                options.loops && !recording.loops.empty()};
  if (recording.sightings.empty() && used.truth.empty() && used.fixes.empty() && !used.loops) {
    throw InputError(
        recording.name, 0,
        "neither sightings, truth, fixes nor loops in use, expected some to adjust to");
  }
  return used;
}

std::vector<double> session_instants(const DrivenRecording& recording, const RowsUsed& used,
                                     const Robot& robot, const ProblemOptions& options,
                                     const std::vector<TimeSpan>& left_out) {
  const std::vector<double> times = outside(times_measured(recording, used), left_out);
  std::vector<double> instants;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k > 0 && !recording::overlaps_any({times[k - 1], times[k]}, left_out)) {
      const std::vector<SegmentRow> rows = segment_rows(recording.drive, times[k - 1], times[k]);
      for (const double t : motion_changes(recording.drive, rows, robot,
                                           {options.least_spin, options.least_drive})) {
        if (t > times[k - 1] && t < times[k]) instants.push_back(t);
      }
    }
    instants.push_back(times[k]);
  }
  return instants;
}

}  // namespace trussmap::estimation
