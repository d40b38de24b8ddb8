// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/problem_part.hpp"

#include <algorithm>

namespace trussmap::estimation {
namespace {

/// Numbers in a part, by those in the whole problem; -1: not in it.
struct PartNumbers {
  std::vector<int> landmark;
  std::vector<int> orientation;
};

bool lies_within(const RecordingProblem& problem, const Measurement& one, const PoseSpan& span) {
  if (tells_of_map(one)) return false;
  const auto inside = [first = problem.pose_node(span.first), &span](int node) {
    return node >= first && node < first + span.count;
  };
  if (!inside(one.from) || (is_between_poses(one) && !inside(one.to))) return false;
  // What a segment's gyro says goes with it.
  return !is_driven(one) || inside(one.from + 1);
}

/// What it sees gets its number in the part. False of a yaw whose sighting, just before, is not
/// kept.
bool number_seen(const RecordingProblem& problem, const Measurement& one, PartNumbers& numbers,
                 ProblemPart& part) {
  if (is_yaw(one)) {
    const int whole = one.to - problem.pose_end();
    const int landmark = numbers.landmark[idx(problem.oriented[idx(whole)])];
    if (landmark < 0) return false;
    int& number = numbers.orientation[idx(whole)];
    if (number >= 0) return true;
    number = static_cast<int>(part.orientations.size());
    part.orientations.push_back(whole);
    part.problem.oriented.push_back(landmark);
  } else if (is_sighting(one) && numbers.landmark[idx(one.to)] < 0) {
    numbers.landmark[idx(one.to)] = static_cast<int>(part.landmarks.size());
    part.landmarks.push_back(one.to);
    part.problem.landmarks.push_back(problem.landmarks[idx(one.to)]);
  }
  return true;
}

void add_renumbered(const RecordingProblem& problem, const Measurement& one,
                    const PartNumbers& numbers, const PoseSpan& span, RecordingProblem& part) {
  const int offset = problem.pose_node(span.first);
  Measurement moved = one;
  moved.from = part.pose_node(one.from - offset);
  if (is_between_poses(one)) {
    moved.to = part.pose_node(one.to - offset);
  } else if (is_yaw(one)) {
    moved.to = part.pose_end() + numbers.orientation[idx(one.to - problem.pose_end())];
  } else if (is_sighting(one)) {
    moved.to = numbers.landmark[idx(one.to)];
  }
  if (is_segment(one)) {
    part.segments.push_back(problem.segments[one.source]);
    part.gyro_weights.push_back(problem.gyro_weights[one.source]);
  }
  // A gyro's rows come right after their segment.
  if (is_driven(one)) moved.source = part.segments.size() - 1;
  part.measurements.push_back(moved);
}

}  // namespace

std::vector<PoseSpan> session_spans(const RecordingProblem& problem) {
  std::vector<PoseSpan> spans(problem.sessions.size());
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    auto& [first, count] = spans[idx(problem.poses[k].session)];
    if (count++ == 0) first = static_cast<int>(k);
  }
  return spans;
}

ProblemPart part_of(const RecordingProblem& problem, const PoseSpan& span,
                    const PlacedLandmarks* placed) {
  ProblemPart part;
  PartNumbers numbers{std::vector<int>(problem.landmarks.size(), -1),
                      std::vector<int>(problem.oriented.size(), -1)};
  std::vector<const Measurement*> kept;
  for (const Measurement& one : problem.measurements) {
    if (!lies_within(problem, one, span)) continue;
    if (placed != nullptr && is_sighting(one) && !(*placed)[idx(one.to)]) continue;
    if (number_seen(problem, one, numbers, part)) kept.push_back(&one);
  }
  const auto begin = problem.poses.begin() + span.first;
  part.problem.poses.assign(begin, begin + span.count);
  part.problem.sessions = problem.sessions;
  for (const Measurement* one : kept) add_renumbered(problem, *one, numbers, span, part.problem);
  return part;
}

ProblemPart session_of(const RecordingProblem& problem, const PoseSpan& span) {
  ProblemPart part = part_of(problem, span);
  std::vector<Measurement>& measurements = part.problem.measurements;
  for (const Measurement& one : problem.measurements) {
    const int pose = one.from - problem.pose_node(span.first);
    if (one.session < 0 || !tells_of_map(one) || pose < 0 || pose >= span.count) continue;
    measurements.push_back(one);
    measurements.back().from = part.problem.pose_node(pose);
  }
  if (!has_compass(part.problem)) return part;
  std::erase_if(measurements, [](const Measurement& one) { return is_of_orientation(one); });
  part.problem.oriented.clear();
  part.orientations.clear();
  return part;
}

bool has_compass(const RecordingProblem& problem) {
  return std::any_of(problem.measurements.begin(), problem.measurements.end(), reads_compass);
}

bool has_loops(const RecordingProblem& problem) {
  return std::any_of(problem.measurements.begin(), problem.measurements.end(), is_tie);
}

}  // namespace trussmap::estimation
