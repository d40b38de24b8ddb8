// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/training.hpp"

#include "estimation/recording_descent.hpp"
#include "estimation/recording_start.hpp"
#include "fit/along_paths.hpp"
#include "recording/time_spans.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace trussmap::validation {
namespace {

constexpr double kForever = 1e300;  // s

/// Held-out legs, and what the fit leaves out anyway, as spans of time.
std::vector<std::vector<TimeSpan>> spans_without(const std::vector<LegSpan>& legs,
                                                 const fitting::FitState& fit) {
  std::vector<std::vector<TimeSpan>> spans = fit.used.left_out;
  spans.resize(fit.recordings.size());
  for (const LegSpan& leg : legs) {
    if (leg.held_out) spans[idx(leg.session)].push_back(leg.time);
  }
  for (std::vector<TimeSpan>& one : spans) one = recording::merged(std::move(one));
  return spans;
}

/// Poses that are not connected to the map, or else of which something can move freely.
std::set<int> loose_poses(const std::vector<DrivenRecording>& recordings,
                          const fitting::FitState& fit,
                          const estimation::RecordingProblem& problem) {
  const std::vector<int> untied = estimation::untied_poses(problem);
  if (!untied.empty()) return {untied.begin(), untied.end()};
  const std::map<std::string, Vector2> places = fitting::landmark_places(fit);
  const estimation::RecordingState state =
      fitting::along_paths(problem, recordings, fit.paths, places);
  const estimation::EffectParameters no_effects;
  estimation::RecordingSystem system(problem, no_effects);
  system.linearise(state, Eigen::VectorXd());
  const std::vector<int> loose = estimation::find_loose_nodes(system);
  const std::set<int> nodes(loose.begin(), loose.end());
  std::set<int> poses;
  for (const estimation::Measurement& one : problem.measurements) {
    if (one.session < 0) continue;
    if (nodes.contains(one.from) || nodes.contains(one.to)) {
      poses.insert(one.from - problem.landmark_count());
    }
  }
  return poses;
}

/// Whole segments between spans in which something is loose are left out too.
void leave_unconnected_segments_out(const std::vector<DrivenRecording>& recordings,
                                    const fitting::FitState& fit,
                                    estimation::ProblemOptions& options) {
  for (int round = 0; round < 20; ++round) {
    const estimation::RecordingProblem problem =
        estimation::make_problem(recordings, fit.model, options);
    const std::set<int> poses = loose_poses(recordings, fit, problem);
    if (poses.empty()) return;
    for (const int k : poses) {
      const estimation::PoseNode& pose = problem.poses[idx(k)];
      std::vector<TimeSpan>& spans = options.left_out[idx(pose.session)];
      const bool gone = std::any_of(spans.begin(), spans.end(), [&](const TimeSpan& span) {
        return span.from < pose.t && pose.t < span.to;
      });
      if (gone) continue;  // with another pose of its segment
      // From the beginning of the span before it to the end of the span after it.
      TimeSpan segment{-kForever, kForever};
      for (const TimeSpan& span : spans) {
        if (span.to <= pose.t) segment.from = std::max(segment.from, span.from);
        if (span.from >= pose.t) segment.to = std::min(segment.to, span.to);
      }
      std::erase_if(spans, [&](const TimeSpan& span) {
        return span.from >= segment.from && span.to <= segment.to;
      });
      spans.push_back(segment);
      std::sort(spans.begin(), spans.end(),
                [](const TimeSpan& a, const TimeSpan& b) { return a.from < b.from; });
    }
  }
}

}  // namespace

std::vector<std::vector<TimeSpan>> recorded_spans(std::vector<std::vector<TimeSpan>> spans,
                                                  const std::vector<DrivenRecording>& recordings,
                                                  const fitting::FitState& fit) {
  const Model& model = fit.model;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    std::vector<double> recorded;
    for (const Sighting& sighting : recordings[s].sightings) recorded.push_back(sighting.t);
    for (const TruthRow& row : recordings[s].truth) recorded.push_back(row.t);
    const Channel delay = fitting::delay_of_legs(recordings[s]);
    if (delay == Channel::fix_delay) {
      for (const Fix& fix : recordings[s].fixes) recorded.push_back(fix.t);
    }
    if (recorded.empty()) continue;  // no leg ends anywhere
    const std::vector<double> moved = fitting::retimed(
        recorded, recordings[s], s, recordings.size(), model.effects, model.robot, delay);
    std::map<double, double> back;
    for (std::size_t k = 0; k < moved.size(); ++k) back[moved[k]] = recorded[k];
    // The nearest: the fit's coefficients have moved a little since it took its delays out.
    const auto recorded_at = [&back](double t) {
      auto after = back.lower_bound(t);
      if (after == back.begin()) return after->second;
      const auto before = std::prev(after);
      return after == back.end() || t - before->first < after->first - t ? before->second
                                                                         : after->second;
    };
    for (TimeSpan& span : spans[s]) {
      if (span.from > -kForever) span.from = recorded_at(span.from);
      if (span.to < kForever) span.to = recorded_at(span.to);
    }
  }
  return spans;
}

std::vector<std::vector<TimeSpan>> with_unconnected(std::vector<std::vector<TimeSpan>> spans,
                                                    const fitting::FitState& fit) {
  estimation::ProblemOptions options = fit.used;
  options.left_out = std::move(spans);
  leave_unconnected_segments_out(fit.recordings, fit, options);
  return std::move(options.left_out);
}

fitting::FitState fit_without(const std::vector<LegSpan>& legs,
                              const std::vector<DrivenRecording>& recordings,
                              const fitting::FitState& fit, const fitting::FitterOptions& options) {
  fitting::FitterOptions how = options;
  how.fit_effects = true;
  how.near = &fit;
  how.still = 1e-5;  // errors of legs are not read so finely
  how.problem.left_out =
      recorded_spans(with_unconnected(spans_without(legs, fit), fit), recordings, fit);
  // What was excluded begins and ends anywhere, not at instants that a delay moves.
  for (std::size_t s = 0; s < options.problem.left_out.size(); ++s) {
    std::vector<TimeSpan>& spans = how.problem.left_out.at(s);
    std::ranges::copy(options.problem.left_out[s], std::back_inserter(spans));
    spans = recording::merged(std::move(spans));
  }
  return fitting::fit_recordings(recordings, fit.model, how);
}

}  // namespace trussmap::validation
