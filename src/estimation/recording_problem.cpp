// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_problem.hpp"

#include "estimation/gyro_excess.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/mounted_views.hpp"
#include "estimation/noise_states.hpp"
#include "estimation/session_instants.hpp"
#include "parallel/parallel_for.hpp"
#include "recording/repeated_rows.hpp"
#include "recording/time_spans.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace trussmap::estimation {
namespace {

/// A problem while session after session joins it: poses and orientations count from 0, until every
/// landmark has its node.
struct GrowingProblem {
  RecordingProblem problem;
  std::map<std::string, int> landmark_node;
  std::map<int, int> orientation;  ///< of a landmark
};

/// One session's poses.
struct SessionPoses {
  int session = 0;
  std::vector<TimeSpan> left_out;
  std::map<double, int> at;  ///< by time
};

/// The drives between successive poses that count.
struct SessionSegments {
  std::vector<Measurement> measured;  ///< from and to poses
  std::vector<std::vector<SegmentRow>> rows;
};

SessionSegments segments_of(const SessionPoses& poses, const MotionRows& drive,
                            const Model& model) {
  using Node = std::pair<const double, int>;
  std::vector<std::pair<const Node*, const Node*>> ends;
  for (auto to = poses.at.begin(), from = to; to != poses.at.end(); from = to++) {
    if (from == to || recording::overlaps_any({from->first, to->first}, poses.left_out)) continue;
    ends.emplace_back(&*from, &*to);
  }
  SessionSegments segments{std::vector<Measurement>(ends.size()),
                           std::vector<std::vector<SegmentRow>>(ends.size())};
  parallel::parallel_for(ends.size(), [&](std::size_t k) {
    const auto& [from, to] = ends[k];
    std::vector<SegmentRow>& rows = segments.rows[k];
    rows = segment_rows(drive, from->first, to->first);
    Measurement& one = segments.measured[k];
    one = kinds::segment_measured(segment_motion(rows),
                                  segment_covariance(drive, rows, model.robot, model.noise));
    one.from = from->second;
    one.to = to->second;
    one.session = poses.session;
  });
  return segments;
}

RecordingProblem with_segments(RecordingProblem problem, SessionSegments segments,
                               const MotionRows& drive, const Model& model) {
  for (std::size_t k = 0; k < segments.measured.size(); ++k) {
    Measurement& one = segments.measured[k];
    one.source = problem.segments.size();
    GyroExcess excess = gyro_excess(drive, segments.rows[k], model.robot, model.noise);
    problem.segments.push_back(std::move(segments.rows[k]));
    problem.measurements.push_back(one);
    if (excess.rows > 0) {
      Measurement gyro = kinds::gyro_measured(excess);
      gyro.from = one.from;
      gyro.session = one.session;
      gyro.source = one.source;
      problem.measurements.push_back(gyro);
    }
    problem.gyro_weights.push_back(std::move(excess.weights));
  }
  return problem;
}

/// The number of a key, which is the next one where it is new.
template <typename Key, typename Named>
int numbered(std::map<Key, int>& numbers, const Key& key, std::vector<Named>& all) {
  const auto [at, fresh] = numbers.try_emplace(key, static_cast<int>(all.size()));
  if (fresh) all.push_back(key);
  return at->second;
}

GrowingProblem with_sightings(GrowingProblem growing, const std::vector<Sighting>& sightings,
                              const SessionPoses& poses, const Noise& noise) {
  RecordingProblem& problem = growing.problem;
  const std::vector<bool> repeated = recording::repeated_rows(sightings);  // one measurement each
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    const auto pose = poses.at.find(sightings[k].t);
    if (pose == poses.at.end() || repeated[k]) continue;
    const auto add = [&](Measurement one, int to) {
      one.from = pose->second;
      one.to = to;
      one.session = poses.session;
      one.source = k;
      problem.measurements.push_back(one);
    };
    const int landmark = numbered(growing.landmark_node, sightings[k].landmark, problem.landmarks);
    add(kinds::measured_by(sightings[k], noise), landmark);
    if (const auto yaw = kinds::yaw_measured(sightings[k], noise)) {
      add(*yaw, numbered(growing.orientation, landmark, problem.oriented));
    }
  }
  return growing;
}

/// Truth, fixes and loops, of poses that are not left out.
RecordingProblem with_places(RecordingProblem problem, const DrivenRecording& recording,
                             const RowsUsed& used, const SessionPoses& poses, const Noise& noise) {
  const auto add = [&](Measurement one, double from, std::size_t source) {
    const auto pose = poses.at.find(from);
    if (pose == poses.at.end()) return;
    one.from = pose->second;
    one.session = poses.session;
    one.source = source;
    problem.measurements.push_back(one);
  };
  for (const std::size_t k : used.truth) {
    add(kinds::measured_by(recording.truth[k], noise), recording.truth[k].t, k);
  }
  for (const std::size_t k : used.fixes) {
    add(kinds::measured_by(recording.fixes[k], noise), recording.fixes[k].t, k);
  }
  const std::vector<bool> repeated = recording::repeated_rows(recording.loops);
  for (std::size_t k = 0; used.loops && k < recording.loops.size(); ++k) {
    const Loop& loop = recording.loops[k];
    const auto to = poses.at.find(loop.t2);
    if (to == poses.at.end() || repeated[k]) continue;
    Measurement one = kinds::measured_by(loop, noise);
    one.to = to->second;
    add(one, loop.t, k);
  }
  return problem;
}

GrowingProblem with_session(GrowingProblem growing, const DrivenRecording& recording,
                            const Model& model, const ProblemOptions& options) {
  RecordingProblem& problem = growing.problem;
  SessionPoses poses;
  poses.session = static_cast<int>(problem.sessions.size());
  problem.sessions.push_back(recording.name);
  const RowsUsed used = rows_used(recording, options);
  if (!options.left_out.empty()) poses.left_out = options.left_out[idx(poses.session)];
  for (const double t : session_instants(recording, used, model.robot, options, poses.left_out)) {
    poses.at[t] = static_cast<int>(problem.poses.size());
    problem.poses.push_back({poses.session, t});
  }
  problem = with_segments(std::move(problem), segments_of(poses, recording.drive, model),
                          recording.drive, model);
  growing = with_sightings(std::move(growing), recording.sightings, poses, model.noise);
  growing.problem = with_places(std::move(growing.problem), recording, used, poses, model.noise);
  return growing;
}

/// After all sessions, so that every sighted landmark has its node. Sessions come with copies of
/// one survey: the same numbers count once.
GrowingProblem with_surveys(GrowingProblem growing, const std::vector<DrivenRecording>& recordings,
                            const Noise& noise) {
  std::set<std::tuple<int, double, double>> places;
  std::set<std::tuple<int, double, double, double>> headings;
  const auto add = [&growing](Measurement one, int from, std::size_t source) {
    one.from = from;
    one.source = source;
    growing.problem.measurements.push_back(one);
  };
  for (const DrivenRecording& recording : recordings) {
    for (std::size_t k = 0; k < recording.survey.size(); ++k) {
      const SurveyPoint& point = recording.survey[k];
      const auto node = growing.landmark_node.find(point.landmark);
      if (node == growing.landmark_node.end()) continue;
      if (places.emplace(node->second, point.x, point.y).second) {
        add(kinds::measured_by(point, noise), node->second, k);
      }
      const auto orientation = growing.orientation.find(node->second);
      if (std::isnan(point.heading) || orientation == growing.orientation.end()) continue;
      if (headings.emplace(node->second, point.x, point.y, point.heading).second) {
        add(kinds::heading_measured(point, noise), orientation->second, k);
      }
    }
  }
  return growing;
}

/// Of what its type counts.
int node_of(const RecordingProblem& problem, NodeType type, int number) {
  switch (type) {
    case NodeType::pose:
      return problem.pose_node(number);
    case NodeType::orientation:
      return problem.pose_end() + number;
    case NodeType::landmark:
    case NodeType::none:
      break;
  }
  return number;
}

}  // namespace

namespace {

/// Its view begins where the model has its sensor. What a robot that stands on a code on the floor
/// sees of it is turned into the robot's axes.
void mount(Measurement& one, const Mountings& mounted) {
  one.mounted = mounted_view(mounted, one.kind->facts().stream);
  if (!is_standing(one)) return;
  one.value.head<2>() = rotation(one.mounted.heading) * one.value.head<2>().eval();
  one.mounted.heading = 0.0;
}

}  // namespace

RecordingProblem make_problem(const std::vector<DrivenRecording>& recordings, const Model& model,
                              const ProblemOptions& options) {
  GrowingProblem growing;
  for (const DrivenRecording& recording : recordings) {
    growing = with_session(std::move(growing), recording, model, options);
  }
  if (options.survey) growing = with_surveys(std::move(growing), recordings, model.noise);
  RecordingProblem problem = std::move(growing.problem);
  for (Measurement& one : problem.measurements) {
    one.from = node_of(problem, one.kind->facts().from, one.from);
    one.to = node_of(problem, one.kind->facts().to, one.to);
    mount(one, model.robot.mounted);
  }
  add_processes(problem, recordings, model);
  return problem;
}

std::string describe(const RecordingProblem& problem, const Measurement& measurement) {
  const KindFacts& facts = measurement.kind->facts();
  std::string words(facts.words);
  const auto of = [&](NodeType type, int node) {
    if (type == NodeType::landmark) words += " landmark " + problem.landmarks[idx(node)];
    if (type == NodeType::orientation) words += " landmark " + problem.landmark_of(node);
  };
  const auto at = [&](const char* when, int node) {
    words += when + text::fixed_text(problem.time_of(node), 3) + " s";
  };
  of(facts.from, measurement.from);
  of(facts.to, measurement.to);
  if (facts.from == NodeType::pose) {
    const bool lasts = is_driven(measurement) || is_between_poses(measurement);
    at(lasts ? " from t = " : " at t = ", measurement.from);
  }
  if (is_between_poses(measurement)) at(" to ", measurement.to);
  if (problem.sessions.size() > 1 && measurement.session >= 0) {
    words += " of " + problem.sessions[idx(measurement.session)];
  }
  return words;
}

}  // namespace trussmap::estimation
