// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_start.hpp"

#include "estimation/fix_alignment.hpp"
#include "estimation/laid_session.hpp"
#include "estimation/problem_part.hpp"
#include "estimation/session_joining.hpp"
#include "estimation/stretch_adjustment.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::estimation {
namespace {

bool gives_frame(const RecordingProblem& problem) {
  return std::any_of(problem.measurements.begin(), problem.measurements.end(), is_in_map_frame);
}

/// The first pose with a truth row.
std::optional<std::pair<int, const Measurement*>> first_truth(const SessionToLay& session) {
  for (int k = 0; k < session.pose_count(); ++k) {
    for (const Measurement* one : session.seen_at[idx(k)]) {
      if (gives_pose(*one)) return std::pair(k, one);
    }
  }
  return std::nullopt;
}

/// In the frame of the session's truth, from its first row both ways.
LaidSession lay_from_truth(const SessionToLay& session, int first, const Measurement& truth,
                           LaidSession laid) {
  const int poses = session.pose_count();
  const double heading = truth.value[2] - truth.mounted.heading;
  const Vector2 place =
      truth.value.head<2>() - rotation(heading) * Vector2(truth.mounted.ahead, truth.mounted.left);
  const KnownPose start{{place.x(), place.y(), heading}, covariance_of(truth)};
  laid = lay_poses(session, std::move(laid), first, poses - 1, start);
  laid = lay_backwards(session, std::move(laid), first);
  return place_from_afar(session, std::move(laid), poses, true);
}

/// In a frame of its own, stretch by stretch.
LaidSession lay_freely(const SessionToLay& session, LaidSession laid) {
  constexpr int kShortestStretch = 7;
  constexpr double kLost = 0.12;  // share of the sightings: the robot took a wrong turn
  /// Poses adjusted, of all: beyond, the sightings contradict each other whatever turn is taken,
  /// and short stretches, each of which adjusts all before it, would cost the square of their
  /// number.
  constexpr double kMostCare = 30.0;
  const StartOptions& options = session.options;
  const int poses = session.pose_count();
  const Matrix3 adjusted = Eigen::Vector3d(1e-2, 1e-2, 1e-3).asDiagonal();
  int count = std::min(poses, options.first_stretch);
  laid = lay_poses(session, std::move(laid), 0, count - 1, start_of_frame(session));
  laid = place_from_afar(session, std::move(laid), count, count == poses);
  if (count < poses) laid = adjust_stretch(session, std::move(laid), count).laid;
  int longest = poses;
  double care = 0.0;
  while (count < poses) {
    const bool careful = options.careful && care < kMostCare;
    const int stretch = std::min(longest, std::max(2 * options.first_stretch / 3, count / 3));
    const int next = std::min(poses, count + stretch);
    const KnownPose from{laid.poses[idx(count - 1)], adjusted};
    LaidSession longer = lay_poses(session, laid, count - 1, next - 1, from);
    longer = place_from_afar(session, std::move(longer), next, next == poses);
    if (next == poses && !careful) return longer;
    AdjustedStretch fit = adjust_stretch(session, std::move(longer), next);
    care += static_cast<double>(next) / poses;
    if (careful && fit.lost > kLost && stretch > kShortestStretch) {
      longest = std::max(kShortestStretch, stretch / 3);
      continue;
    }
    laid = std::move(fit.laid);
    count = next;
    longest = careful ? std::min(poses, 2 * longest) : poses;
  }
  return laid;
}

/// In the map's frame where truth or fixes give it.
LaidSession lay_session(const SessionToLay& session, LaidSession nothing) {
  if (const auto truth = first_truth(session)) {
    return lay_from_truth(session, truth->first, *truth->second, std::move(nothing));
  }
  const SessionFixes fixes = fixes_of(session.problem);
  if (fixes.poses.empty()) return lay_freely(session, std::move(nothing));
  const std::vector<Measurement>& all = session.problem.measurements;
  if (std::ssize(fixes.poses) >= std::count_if(all.begin(), all.end(), locates)) {
    return lay_along_fixes(session, fixes, std::move(nothing));
  }
  return lay_onto_fixes(fixes, lay_freely(session, std::move(nothing)));
}

/// With the first landmark at the origin.
RecordingState from_first_landmark(RecordingState state) {
  if (state.landmarks.empty()) return state;
  const Vector2 origin = state.landmarks.front();
  for (Vector2& landmark : state.landmarks) landmark -= origin;
  for (Pose& pose : state.poses) {
    pose.x -= origin.x();
    pose.y -= origin.y();
  }
  return state;
}

}  // namespace

std::vector<double> orientations_seen_from(const RecordingProblem& problem,
                                           const std::vector<Pose>& poses) {
  std::vector<Vector2> sums(problem.oriented.size(), Vector2::Zero());
  for (const Measurement& one : problem.measurements) {
    if (!is_yaw(one)) continue;
    const Pose& pose = poses[idx(one.from - problem.landmark_count())];
    sums[idx(one.to - problem.pose_end())] +=
        rotation(pose.heading + one.mounted.heading + one.value[0]).col(0);
  }
  std::vector<double> result;
  result.reserve(sums.size());
  for (const Vector2& sum : sums) result.push_back(direction(sum));
  for (const Measurement& one : problem.measurements) {
    if (!is_surveyed_heading(one)) continue;
    result[idx(one.from - problem.pose_end())] = one.value[0];
  }
  return result;
}

RecordingStart start_of(const RecordingProblem& problem, const EffectParameters& border,
                        const StartOptions& options) {
  MapSoFar known = surveyed_map(problem);
  RecordingState state;
  state.poses.resize(problem.poses.size());
  KnownCoefficients coefficients = prior_of(border);
  for (const PoseSpan& span : session_spans(problem)) {
    if (span.count == 0) continue;
    const ProblemPart part = session_of(problem, span);
    const SessionToLay session(part.problem, border, options);
    LaidSession laid = lay_session(session, nothing_laid(part.problem, coefficients));
    if (!gives_frame(part.problem)) laid = lay_over(known, part, std::move(laid));
    known = with_session(std::move(known), problem, span, part, laid);
    std::copy(laid.poses.begin(), laid.poses.end(), state.poses.begin() + span.first);
    coefficients = std::move(laid.coefficients);
  }
  for (const std::optional<Vector2>& landmark : known.landmarks) {
    state.landmarks.push_back(landmark.value_or(Vector2::Zero()));
  }
  if (!gives_frame(problem)) state = from_first_landmark(std::move(state));
  state.orientations = orientations_seen_from(problem, state.poses);
  return {std::move(state), std::move(coefficients.values)};
}

RecordingState dead_reckoned(const RecordingProblem& problem) {
  const EffectParameters no_effects;
  RecordingState state;
  state.poses.resize(problem.poses.size());
  std::vector<Vector2> sums(problem.landmarks.size(), Vector2::Zero());
  std::vector<double> counts(problem.landmarks.size(), 0.0);
  for (const PoseSpan& span : session_spans(problem)) {
    if (span.count == 0) continue;
    const ProblemPart part = part_of(problem, span);
    const SessionToLay session(part.problem, no_effects);
    const LaidSession laid = lay_poses(session, nothing_laid(part.problem, prior_of(no_effects)), 0,
                                       span.count - 1, start_of_frame(session), false);
    std::copy(laid.poses.begin(), laid.poses.end(), state.poses.begin() + span.first);
    for (int k = 0; k < span.count; ++k) {
      const Pose& pose = laid.poses[idx(k)];
      for (const Measurement* one : session.seen_at[idx(k)]) {
        if (!locates(*one)) continue;
        const std::size_t landmark = idx(part.landmarks[idx(one->to)]);
        sums[landmark] += *one->kind->seen_from(*one, pose, one->mounted);
        counts[landmark] += 1.0;
      }
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    state.landmarks.emplace_back(sums[k] / std::max(counts[k], 1.0));
  }
  state.orientations = orientations_seen_from(problem, state.poses);
  return state;
}

}  // namespace trussmap::estimation
