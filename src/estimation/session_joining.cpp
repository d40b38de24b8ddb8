// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/session_joining.hpp"

#include "statistics/median.hpp"

#include <algorithm>

namespace trussmap::estimation {
namespace {

/// Places of the same landmarks in a session and in the map.
struct CommonPlaces {
  std::vector<Vector2> here;
  std::vector<Vector2> there;
};

CommonPlaces common_places(const MapSoFar& known, const ProblemPart& session,
                           const LaidSession& laid) {
  CommonPlaces common;
  for (std::size_t k = 0; k < session.landmarks.size(); ++k) {
    const std::optional<Vector2>& there = known.landmarks[idx(session.landmarks[k])];
    if (!there || !laid.landmarks[k]) continue;
    common.here.push_back(*laid.landmarks[k]);
    common.there.push_back(*there);
  }
  return common;
}

Vector2 median_place(const std::vector<Vector2>& places) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Vector2& at : places) {
    x.push_back(at.x());
    y.push_back(at.y());
  }
  return {statistics::median(x), statistics::median(y)};
}

/// Without landmarks that lie here, of those that lie there, ten times as far apart as any there:
/// bearings alone may put one anywhere, and it would take the rest with it.
CommonPlaces without_strays(const CommonPlaces& common) {
  constexpr double kStray = 10.0;
  const Vector2 middle = median_place(common.here);
  const Vector2 middle_there = median_place(common.there);
  double reach = 0.0;
  for (const Vector2& at : common.there) reach = std::max(reach, (at - middle_there).norm());
  CommonPlaces kept;
  for (std::size_t k = 0; k < common.here.size(); ++k) {
    if ((common.here[k] - middle).norm() > kStray * reach) continue;
    kept.here.push_back(common.here[k]);
    kept.there.push_back(common.there[k]);
  }
  return kept.here.empty() ? common : kept;
}

/// rad, what turns a session's orientations into those known; nothing where it has none of them.
std::optional<double> turn_onto(const KnownOrientations& known, const ProblemPart& session,
                                const LaidSession& laid) {
  Vector2 sum = Vector2::Zero();
  for (std::size_t k = 0; k < session.orientations.size(); ++k) {
    const std::optional<double>& there = known[idx(session.orientations[k])];
    if (!there || !laid.orientations[k]) continue;
    sum += rotation(*there - *laid.orientations[k]).col(0);
  }
  if (sum.norm() <= 0.0) return std::nullopt;
  return direction(sum);
}

/// Turned by so much about its origin, then shifted to where the places lie in the mean.
Alignment shift_onto(const CommonPlaces& common, double angle) {
  Alignment over;
  over.angle = angle;
  const Matrix2 R = rotation(over.angle);
  const auto count = static_cast<double>(common.here.size());
  for (std::size_t k = 0; k < common.here.size(); ++k) {
    over.translation += (common.there[k] - R * common.here[k]) / count;
  }
  return over;
}

}  // namespace

MapSoFar surveyed_map(const RecordingProblem& problem) {
  MapSoFar known{PlacedLandmarks(problem.landmarks.size()),
                 KnownOrientations(problem.oriented.size())};
  for (const Measurement& one : problem.measurements) {
    if (is_surveyed_place(one)) {
      known.landmarks[idx(one.from)] = one.value.head<2>();
    } else if (is_surveyed_heading(one)) {
      known.orientations[idx(one.from - problem.pose_end())] = one.value[0];
    }
  }
  return known;
}

LaidSession lay_over(const MapSoFar& known, const ProblemPart& session, LaidSession laid) {
  constexpr std::size_t kTellsTurn = 3;  // landmarks
  CommonPlaces common = common_places(known, session, laid);
  if (common.here.empty()) return laid;
  common = without_strays(common);
  const std::size_t count = common.here.size();
  const bool turns = !has_compass(session.problem);
  std::optional<double> angle;
  if (turns && count < kTellsTurn) angle = turn_onto(known.orientations, session, laid);
  const Alignment over = turns && !angle && count >= 2 ? align_rigidly(common.here, common.there)
                                                       : shift_onto(common, angle.value_or(0.0));
  return moved_by(over, std::move(laid));
}

MapSoFar with_session(MapSoFar known, const RecordingProblem& problem, const PoseSpan& span,
                      const ProblemPart& session, const LaidSession& laid) {
  for (std::size_t k = 0; k < session.landmarks.size(); ++k) {
    std::optional<Vector2>& place = known.landmarks[idx(session.landmarks[k])];
    if (!place) place = laid.landmarks[k];
  }
  if (known.orientations.empty()) return known;
  for (const Measurement& one : problem.measurements) {
    if (!is_yaw(one)) continue;
    const int pose = one.from - problem.pose_node(span.first);
    if (pose < 0 || pose >= span.count) continue;
    std::optional<double>& orientation = known.orientations[idx(one.to - problem.pose_end())];
    if (!orientation) {
      orientation = wrap_angle(laid.poses[idx(pose)].heading + one.mounted.heading + one.value[0]);
    }
  }
  return known;
}

}  // namespace trussmap::estimation
