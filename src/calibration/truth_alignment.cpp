// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/truth_alignment.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

// Far beyond what a marker put on by hand or two logs cut by hand are off by.
constexpr double kLeverSd = 0.3;    // m
constexpr double kHeadingSd = 0.1;  // rad
constexpr double kLateSd = 0.3;     // s
constexpr double kClockSd = 0.001;  // s/s

/// Where the robot was `late` seconds before time t, seen from where it is at t; at rest outside
/// of the drive.
Pose way_back(const Drive& drive, double t, double late, const Robot& robot) {
  const auto inside = [&drive](double at) { return std::clamp(at, drive.start(), drive.t.back()); };
  const double from = inside(std::min(t, t - late));
  const double to = inside(std::max(t, t - late));
  if (!(to > from)) return {};
  const Pose way = segment_motion(segment_rows(drive, from, to, robot)).displacement;
  return late > 0.0 ? inverse(way) : way;
}

/// What one second of lateness does to a truth row: the way back over the lateness of an earlier
/// fit, which is exact there; without one, that of a moment about the row.
ViewPattern per_second(const Drive& drive, double t, double late, const Robot& robot) {
  constexpr double kMoment = 0.15;     // s: longer than a row's jitter
  constexpr double kTellable = 0.005;  // s
  Pose back;
  double seconds = late;
  if (std::abs(late) < kTellable) {
    back = way_back(drive, t + 0.5 * kMoment, kMoment, robot);
    seconds = kMoment;
  } else {
    back = way_back(drive, t, late, robot);
  }
  ViewPattern result;
  result.ahead = back.x / seconds;
  result.left = back.y / seconds;
  result.heading = back.heading / seconds;
  return result;
}

ViewPattern times(const ViewPattern& pattern, double factor) {
  ViewPattern result;
  result.ahead = factor * pattern.ahead;
  result.left = factor * pattern.left;
  result.heading = factor * pattern.heading;
  return result;
}

double lateness(const TruthAlignment& alignment, int session, double t) {
  const auto found = alignment.clocks.find(session);
  if (found == alignment.clocks.end()) return 0.0;
  return found->second.late + found->second.drift * (t - found->second.start);
}

EffectPattern everywhere(const char* name, const ViewPattern& unit, double prior_sd,
                         const std::vector<Recording>& recordings) {
  EffectPattern result;
  result.name = name;
  result.prior_sd = prior_sd;
  for (const Recording& recording : recordings) {
    result.truths.emplace_back(recording.truth.size(), unit);
  }
  return result;
}

int session_of(const std::vector<int>& sessions, std::size_t recording) {
  return sessions.empty() ? static_cast<int>(recording) : sessions[recording];
}

/// Sessions with truth, and when their drives start.
std::map<int, TruthClock> clocks_of(const std::vector<Recording>& recordings,
                                    const std::vector<int>& sessions) {
  std::map<int, TruthClock> clocks;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if (recordings[k].truth.empty()) continue;
    clocks.try_emplace(session_of(sessions, k), TruthClock{0.0, 0.0, recordings[k].drive.start()});
  }
  return clocks;
}

}  // namespace

EffectParameters truth_alignment(const std::vector<Recording>& recordings, const Robot& robot,
                                 const std::vector<int>& sessions, const TruthAlignment& prior) {
  EffectParameters parameters;
  const std::map<int, TruthClock> clocks = clocks_of(recordings, sessions);
  if (clocks.empty()) return parameters;
  ViewPattern unit;
  unit.ahead = 1.0;
  parameters.push_back(everywhere("truth's point, ahead", unit, kLeverSd, recordings));
  unit = {};
  unit.left = 1.0;
  parameters.push_back(everywhere("truth's point, left", unit, kLeverSd, recordings));
  unit = {};
  unit.heading = 1.0;
  parameters.push_back(everywhere("truth's heading", unit, kHeadingSd, recordings));
  for (const auto& [session, start] : clocks) {
    EffectPattern late;
    late.name = "truth late";
    late.prior_sd = kLateSd;
    late.truths.resize(recordings.size());
    EffectPattern clock = late;
    clock.name = "truth's clock";
    clock.prior_sd = kClockSd;
    for (std::size_t k = 0; k < recordings.size(); ++k) {
      if (session_of(sessions, k) != session) continue;
      for (const TruthRow& row : recordings[k].truth) {
        const ViewPattern back =
            per_second(recordings[k].drive, row.t, lateness(prior, session, row.t), robot);
        late.truths[k].push_back(back);
        clock.truths[k].push_back(times(back, row.t - start.start));
      }
    }
    parameters.push_back(std::move(late));
    parameters.push_back(std::move(clock));
  }
  return parameters;
}

TruthAlignment alignment_of(const std::vector<Recording>& recordings,
                            const std::vector<int>& sessions, const Eigen::VectorXd& coefficients) {
  TruthAlignment result;
  result.clocks = clocks_of(recordings, sessions);
  if (result.clocks.empty()) return result;
  result.ahead = coefficients[0];
  result.left = coefficients[1];
  result.heading = coefficients[2];
  Eigen::Index at = 3;
  for (auto& [session, clock] : result.clocks) {
    clock.late = coefficients[at++];
    clock.drift = coefficients[at++];
  }
  return result;
}

std::vector<Recording> aligned(const std::vector<Recording>& recordings,
                               const TruthAlignment& alignment, const Robot& robot) {
  std::vector<Recording> result = recordings;
  for (std::size_t k = 0; k < result.size(); ++k) {
    for (TruthRow& row : result[k].truth) {
      const double late = lateness(alignment, static_cast<int>(k), row.t);
      const Pose back = way_back(result[k].drive, row.t, late, robot);
      row.heading = wrap_angle(row.heading - alignment.heading - back.heading);
      const Vector2 lever =
          rotation(row.heading) * Vector2(alignment.ahead + back.x, alignment.left + back.y);
      row.x -= lever.x();
      row.y -= lever.y();
    }
  }
  return result;
}

}  // namespace trussmap
