// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/visits.hpp"

#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trussmap::check {
namespace {

/// Straight between two rows of truth, the nearest row just outside of them; nothing in gaps.
std::optional<Pose> truth_at(const std::vector<TruthRow>& truth, double t) {
  constexpr double kGap = 1.0;  // s
  const auto after = std::lower_bound(truth.begin(), truth.end(), t,
                                      [](const TruthRow& row, double at) { return row.t < at; });
  if (after == truth.end() || after == truth.begin()) {
    const TruthRow& end = after == truth.end() ? truth.back() : truth.front();
    if (std::abs(end.t - t) > 0.5 * kGap) return std::nullopt;
    return Pose{end.x, end.y, end.heading};
  }
  const TruthRow& a = *(after - 1);
  const TruthRow& b = *after;
  if (b.t - a.t > kGap) return std::nullopt;
  const double share = (t - a.t) / (b.t - a.t);
  return Pose{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
              a.heading + share * wrap_angle(b.heading - a.heading)};
}

/// To a landmark.
struct Return {
  double way;  ///< m driven since
  double off;  ///< m from where it was
  bool seen;
};

std::vector<Return> returns_in(const Visits& visits) {
  std::vector<Return> returns;
  for (const auto& [name, all] : visits) {
    for (std::size_t k = 1; k < all.size(); ++k) {
      if (all[k].t == all[k - 1].t) continue;
      returns.push_back(
          {all[k].way - all[k - 1].way, (all[k].place - all[k - 1].place).norm(), all[k].seen});
    }
  }
  return returns;
}

}  // namespace

Visits visits_of(const Checked& checked, const Track& track, bool by_truth, double pass) {
  Visits visits;
  for (std::size_t row = 0; row < checked.recording.sightings.size(); ++row) {
    const Sighting& one = checked.recording.sightings[row];
    if (!tells_place(one)) continue;
    const double way = track.way_at(one.t);
    std::vector<Visit>& own = visits[one.landmark];
    // Twice in one frame is worth asking.
    if (!own.empty() && way - own.back().way < pass && one.t != own.back().t) continue;
    std::optional<Pose> pose = track.at(one.t);
    if (by_truth) pose = truth_at(checked.recording.truth, one.t);
    if (pose)
      own.push_back({one.t, way, place_seen(one, *pose, checked.angle_unit), !one.standing(), row});
  }
  return visits;
}

double UsualMiss::allowed(const Visit& a, const Visit& b) const {
  return std::max(off, share * std::abs(b.way - a.way));
}

UsualMiss usual_miss(const Visits& visits, bool by_truth) {
  constexpr double kTimes = 6.0;        // the median
  constexpr double kLeast = 1.0;        // m, and
  constexpr double kLeastShare = 0.05;  // of the way
  constexpr std::size_t kFewestReturns = 8;
  std::vector<Return> returns = returns_in(visits);
  if (returns.size() < kFewestReturns) return {};
  std::sort(returns.begin(), returns.end(),
            [](const Return& a, const Return& b) { return a.way < b.way; });
  std::vector<double> shares;
  std::vector<double> offs;  // of what is seen from afar, the third that are soonest
  for (std::size_t k = 0; k < returns.size(); ++k) {
    shares.push_back(returns[k].off / returns[k].way);
    if (3 * k <= returns.size() && returns[k].seen) offs.push_back(returns[k].off);
  }
  UsualMiss usual{true, kLeast, 0.0};
  if (!offs.empty()) usual.off = std::max(kLeast, kTimes * statistics::median(std::move(offs)));
  if (!by_truth)
    usual.share = std::max(kLeastShare, kTimes * statistics::median(std::move(shares)));
  return usual;
}

}  // namespace trussmap::check
