// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/adjustment/truth_alignment.hpp"

#include <algorithm>

namespace trussmap {
namespace {

// Far beyond what a marker put on by hand or two logs cut by hand are off by.
constexpr double kLeverSd = 0.1;    // m
constexpr double kHeadingSd = 0.1;  // rad
constexpr double kLateSd = 0.3;     // s
constexpr double kClockSd = 0.003;  // s/s

struct Rates {
  double speed = 0.0;      // m/s, signed
  double turn_rate = 0.0;  // rad/s
};

/// Means over a moment about time t, short against the motion, long against a row's jitter.
Rates rates_at(const Drive& drive, double t, const Robot& robot) {
  constexpr double kHalf = 0.15;  // s
  const double from = std::max(t - kHalf, drive.start());
  const double to = std::min(t + kHalf, drive.t.back());
  Rates sum;
  if (!(to > from)) return sum;
  for (const PieceRow& row : piece_rows(drive, from, to, robot)) {
    sum.speed += row.path / (to - from);
    sum.turn_rate += row.turn / (to - from);
  }
  return sum;
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

EffectBorder truth_alignment(const std::vector<Recording>& recordings, const Robot& robot,
                             const std::vector<int>& sessions) {
  EffectBorder border;
  const std::map<int, TruthClock> clocks = clocks_of(recordings, sessions);
  if (clocks.empty()) return border;
  ViewPattern unit;
  unit.ahead = 1.0;
  border.push_back(everywhere("truth's point, ahead", unit, kLeverSd, recordings));
  unit = {};
  unit.left = 1.0;
  border.push_back(everywhere("truth's point, left", unit, kLeverSd, recordings));
  unit = {};
  unit.heading = 1.0;
  border.push_back(everywhere("truth's heading", unit, kHeadingSd, recordings));
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
        const Rates rates = rates_at(recordings[k].drive, row.t, robot);
        ViewPattern behind;
        behind.ahead = -rates.speed;
        behind.heading = -rates.turn_rate;
        late.truths[k].push_back(behind);
        behind.ahead *= row.t - start.start;
        behind.heading *= row.t - start.start;
        clock.truths[k].push_back(behind);
      }
    }
    border.push_back(std::move(late));
    border.push_back(std::move(clock));
  }
  return border;
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
    const auto clock = alignment.clocks.find(static_cast<int>(k));
    for (TruthRow& row : result[k].truth) {
      double late = 0.0;
      if (clock != alignment.clocks.end()) {
        late = clock->second.late + clock->second.drift * (row.t - clock->second.start);
      }
      const Rates rates = rates_at(result[k].drive, row.t, robot);
      row.heading = wrap_angle(row.heading - alignment.heading + rates.turn_rate * late);
      const Vector2 lever =
          rotation(row.heading) * Vector2(alignment.ahead - rates.speed * late, alignment.left);
      row.x -= lever.x();
      row.y -= lever.y();
    }
  }
  return result;
}

}  // namespace trussmap
