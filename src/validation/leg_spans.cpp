// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/leg_spans.hpp"

#include "drive/legs.hpp"
#include "recording/time_spans.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace trussmap::validation {
namespace {

void add_sighted_legs(const DrivenRecording& recording, int session,
                      const estimation::RecordingProblem& problem, const LegOptions& options,
                      std::vector<LegSpan>& legs) {
  std::map<std::size_t, std::size_t> measurement_of;  // sighting -> measurement
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (estimation::is_sighting(one) && one.session == session) measurement_of[one.source] = k;
  }
  const std::vector<drive::Stop> stops = drive::stops_of(recording.sightings);
  for (const drive::Leg& leg : drive::legs_of(recording, stops, options.min_drive)) {
    const drive::Stop& from = stops[leg.from];
    const drive::Stop& to = stops[leg.to];
    legs.push_back({legs.size(),
                    session,
                    {from.t, to.t},
                    measurement_of.at(from.reference),
                    measurement_of.at(to.reference),
                    false});
  }
}

/// Between truth rows, or between fixes where there is no truth.
void add_place_legs(const DrivenRecording& recording, int session,
                    const estimation::RecordingProblem& problem, const LegOptions& options,
                    std::vector<LegSpan>& legs) {
  const bool truth = std::any_of(problem.measurements.begin(), problem.measurements.end(),
                                 [session](const estimation::Measurement& one) {
                                   return estimation::gives_pose(one) && one.session == session;
                                 });
  const std::vector<double> path = drive::driven_path(recording.drive);
  bool any = false;
  LegSpan leg;
  double begun = 0.0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (!(truth ? estimation::gives_pose(one) : estimation::is_position(one)) ||
        one.session != session)
      continue;
    const double t = problem.time_of(one.from);
    const double driven = drive::path_at(recording.drive, path, t);
    if (any && driven - begun < options.leg) continue;
    if (any) {
      leg.to = k;
      leg.time.to = t;
      legs.push_back(leg);
    }
    leg = {legs.size(), session, {t, t}, k, k, false};
    begun = driven;
    any = true;
  }
}

}  // namespace

bool is_excluded(const LegSpan& leg, const std::vector<std::vector<TimeSpan>>& excluded) {
  return !excluded.empty() && recording::overlaps_any(leg.time, excluded[idx(leg.session)]);
}

std::vector<LegSpan> leg_spans(const std::vector<DrivenRecording>& recordings,
                               const estimation::RecordingProblem& problem,
                               const LegOptions& options) {
  std::vector<LegSpan> legs;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const int session = static_cast<int>(s);
    if (drive::stops_of(recordings[s].sightings).empty()) {
      add_place_legs(recordings[s], session, problem, options, legs);
    } else {
      add_sighted_legs(recordings[s], session, problem, options, legs);
    }
  }
  for (LegSpan& leg : legs) leg.held_out = drive::is_held_out(leg.number, options.share);
  return legs;
}

std::vector<LegSpan> leg_spans(const fitting::FitState& fit, const LegOptions& options) {
  if (fit.used.left_out.empty()) return leg_spans(fit.recordings, fit.problem, options);
  const estimation::RecordingProblem whole = fitting::whole_problem(fit);
  using Key = std::tuple<const estimation::MeasurementKind*, int, std::size_t>;
  const auto key = [](const estimation::Measurement& one) {
    return Key(one.kind, one.session, one.source);
  };
  std::map<Key, std::size_t> place;
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    place.emplace(key(fit.problem.measurements[k]), k);
  }
  std::vector<LegSpan> legs = leg_spans(fit.recordings, whole, options);
  std::erase_if(legs, [&fit](const LegSpan& leg) { return is_excluded(leg, fit.used.left_out); });
  for (LegSpan& leg : legs) {
    leg.from = place.at(key(whole.measurements[leg.from]));
    leg.to = place.at(key(whole.measurements[leg.to]));
  }
  return legs;
}

}  // namespace trussmap::validation
