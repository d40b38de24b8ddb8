// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/fix_alignment.hpp"

#include "statistics/thinned.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace trussmap::estimation {
namespace {

constexpr double kFarOff = 5.0;       // sds of a fix
constexpr double kDriftShare = 0.05;  // of a stretch: what dead reckoning may be off

/// Where a pose that a fix belongs to is now, and where the fix has it.
struct FixedPlace {
  Vector2 here;
  Vector2 there;
};

double truncated_cost(const Alignment& over, const std::vector<FixedPlace>& places, double limit) {
  double sum = 0.0;
  for (const FixedPlace& one : places) {
    sum += std::min((over.apply(one.here) - one.there).squaredNorm(), limit * limit);
  }
  return sum;
}

/// The rotation and translation that suit most fixes, from pairs of them; those that are further
/// off than `limit` (m) have no say. Shifted only where no two of them are `apart`.
Alignment align_to_most(const std::vector<FixedPlace>& all, double limit, double apart) {
  constexpr std::size_t kPaired = 30;
  constexpr std::size_t kJudged = 300;
  const std::vector<FixedPlace> some = statistics::thinned(all, kPaired);
  const std::vector<FixedPlace> judges = statistics::thinned(all, kJudged);
  Alignment best;
  double least = std::numeric_limits<double>::infinity();
  const auto judge = [&](const Alignment& over) {
    const double cost = truncated_cost(over, judges, limit);
    if (cost >= least) return;
    least = cost;
    best = over;
  };
  for (std::size_t i = 0; i < some.size(); ++i) {
    judge({1.0, 0.0, some[i].there - some[i].here, 0.0});
    for (std::size_t j = i + 1; j < some.size(); ++j) {
      const Vector2 here = some[j].here - some[i].here;
      const Vector2 there = some[j].there - some[i].there;
      if (here.norm() < apart || there.norm() < apart) continue;
      judge(align_rigidly({some[i].here, some[j].here}, {some[i].there, some[j].there}));
    }
  }
  std::vector<Vector2> here;
  std::vector<Vector2> there;
  for (const FixedPlace& one : judges) {
    if ((best.apply(one.here) - one.there).norm() > limit) continue;
    here.push_back(one.here);
    there.push_back(one.there);
  }
  if (best.angle != 0.0 && here.size() >= 2) judge(align_rigidly(here, there));
  return best;
}

/// Where the poses before `end` are to go, by the fixes; `span` (m) is how far they reach.
Alignment onto_fixes(const SessionFixes& fixes, const std::vector<Pose>& poses, int end,
                     double span) {
  std::vector<FixedPlace> places;
  for (std::size_t k = 0; k < fixes.poses.size() && fixes.poses[k] < end; ++k) {
    const Pose& pose = poses[idx(fixes.poses[k])];
    places.push_back({pose.position() + rotation(pose.heading) * fixes.antenna, fixes.places[k]});
  }
  const double limit = std::max(kFarOff * fixes.sd, kDriftShare * span);
  return align_to_most(places, limit, kFarOff * fixes.sd);
}

/// How far the drive by dead reckoning reaches from its first fix on, and up to which fix, where
/// that tells the heading.
struct FirstStretch {
  double span = 0.0;  ///< m
  int end = 0;        ///< of its poses
};

FirstStretch first_stretch_of(const SessionFixes& fixes, const std::vector<Pose>& poses) {
  constexpr double kTellsHeading = 20.0;  // sds of a fix
  constexpr double kShortest = 2.0;       // m
  constexpr std::size_t kFewest = 8;      // fixes
  const double wanted = std::max(kTellsHeading * fixes.sd, kShortest);
  const Vector2 begin = poses[idx(fixes.poses.front())].position();
  double span = 0.0;
  std::size_t count = 0;
  while (count < fixes.poses.size() && (span < wanted || count < kFewest)) {
    span = std::max(span, (poses[idx(fixes.poses[count])].position() - begin).norm());
    ++count;
  }
  return {span, fixes.poses[count - 1] + 1};
}

}  // namespace

SessionFixes fixes_of(const RecordingProblem& session) {
  SessionFixes result;
  std::map<int, const Measurement*> fixes;
  std::vector<double> sds;
  for (const Measurement& one : session.measurements) {
    if (!is_position(one)) continue;
    fixes[one.from - session.landmark_count()] = &one;
    sds.push_back(1.0 / one.whitener(0, 0));
  }
  result.poses.reserve(fixes.size());
  result.places.reserve(fixes.size());
  for (const auto& [pose, one] : fixes) {
    result.antenna = {one->mounted.ahead, one->mounted.left};
    result.poses.push_back(pose);
    result.places.emplace_back(one->value.head<2>());
  }
  if (sds.empty()) return result;
  std::nth_element(sds.begin(), sds.begin() + std::ssize(sds) / 2, sds.end());
  result.sd = sds[sds.size() / 2];
  return result;
}

LaidSession lay_along_fixes(const SessionToLay& session, const SessionFixes& fixes,
                            LaidSession nothing) {
  constexpr double kHeadingSd = 0.3;  // rad
  const int poses = session.pose_count();
  const LaidSession driven =
      lay_poses(session, nothing, 0, poses - 1, start_of_frame(session), false);
  const auto [span, end] = first_stretch_of(fixes, driven.poses);
  const double sd = std::max(fixes.sd, kDriftShare * span);
  const KnownPose start{moved_by(onto_fixes(fixes, driven.poses, end, span), driven.poses.front()),
                        Eigen::Vector3d(sd * sd, sd * sd, kHeadingSd * kHeadingSd).asDiagonal()};
  LaidSession laid = lay_poses(session, std::move(nothing), 0, poses - 1, start);
  return place_from_afar(session, std::move(laid), poses, true);
}

LaidSession lay_onto_fixes(const SessionFixes& fixes, LaidSession laid) {
  double span = 0.0;
  for (const Pose& pose : laid.poses) {
    span = std::max(span, (pose.position() - laid.poses.front().position()).norm());
  }
  const auto poses = static_cast<int>(laid.poses.size());
  const Alignment over = onto_fixes(fixes, laid.poses, poses, span);
  return moved_by(over, std::move(laid));
}

}  // namespace trussmap::estimation
