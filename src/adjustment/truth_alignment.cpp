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

}  // namespace

EffectBorder truth_alignment(const std::vector<Recording>& recordings, const Robot& robot) {
  EffectBorder border;
  if (std::all_of(recordings.begin(), recordings.end(),
                  [](const Recording& one) { return one.truth.empty(); })) {
    return border;
  }
  ViewPattern unit;
  unit.ahead = 1.0;
  border.push_back(everywhere("truth's point, ahead", unit, kLeverSd, recordings));
  unit = {};
  unit.left = 1.0;
  border.push_back(everywhere("truth's point, left", unit, kLeverSd, recordings));
  unit = {};
  unit.heading = 1.0;
  border.push_back(everywhere("truth's heading", unit, kHeadingSd, recordings));
  for (std::size_t session = 0; session < recordings.size(); ++session) {
    const Recording& recording = recordings[session];
    if (recording.truth.empty()) continue;
    EffectPattern late;
    late.name = "truth late";
    late.prior_sd = kLateSd;
    late.truths.resize(recordings.size());
    EffectPattern clock = late;
    clock.name = "truth's clock";
    clock.prior_sd = kClockSd;
    for (const TruthRow& row : recording.truth) {
      const Rates rates = rates_at(recording.drive, row.t, robot);
      ViewPattern behind;
      behind.ahead = -rates.speed;
      behind.heading = -rates.turn_rate;
      late.truths[session].push_back(behind);
      const double since = row.t - recording.drive.start();
      behind.ahead *= since;
      behind.heading *= since;
      clock.truths[session].push_back(behind);
    }
    border.push_back(std::move(late));
    border.push_back(std::move(clock));
  }
  return border;
}

}  // namespace trussmap
