// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/kinds/sighted.hpp"
#include "estimation/laid_session.hpp"
#include "estimation/multilateration.hpp"
#include "estimation/triangulation.hpp"

#include <cmath>
#include <map>

namespace trussmap::estimation {
namespace {

/// Of landmarks that have no place yet.
struct AfarReadings {
  std::map<int, std::vector<RangeReading>> ranges;
  std::map<int, std::vector<DirectionReading>> directions;
};

AfarReadings readings_from_afar(const SessionToLay& session, const LaidSession& laid, int count) {
  constexpr double kHeadingSd = 0.05;  // rad, of the path so far
  AfarReadings found;
  for (int k = 0; k < count; ++k) {
    const Pose& pose = laid.poses[idx(k)];
    for (const Measurement* one : session.seen_at[idx(k)]) {
      if (!is_sighting(*one) || locates(*one) || laid.landmarks[idx(one->to)]) continue;
      const double own = std::sqrt(covariance_of(*one)(0, 0));
      const Vector2 from = sensor_at(pose, one->mounted);
      if (begins_with(*one, "bearing")) {
        found.directions[one->to].push_back({from,
                                             pose.heading + one->mounted.heading + one->value[0],
                                             std::hypot(own, kHeadingSd)});
      } else {
        found.ranges[one->to].push_back(
            {from, one->value[0], std::hypot(own, session.options.map_sd)});
      }
    }
  }
  return found;
}

/// Where the readings have a landmark, if that is certain or, at last, anyway; `stand_in` where
/// they tell nothing.
template <typename Found>
std::optional<Vector2> place_told(const std::optional<Found>& found, const Vector2& stand_in,
                                  bool at_last) {
  if (found && (found->certain || at_last)) return found->place;
  if (!found && at_last) return stand_in;
  return std::nullopt;
}

}  // namespace

LaidSession place_from_afar(const SessionToLay& session, LaidSession laid, int count,
                            bool at_last) {
  const AfarReadings readings = readings_from_afar(session, laid, count);
  for (const auto& [landmark, of_it] : readings.ranges) {
    // Anywhere but along an axis, so that rounding shows which unknown is free.
    const Vector2 stand_in = of_it.front().from + of_it.front().range * rotation(1.0).col(0);
    laid.landmarks[idx(landmark)] = place_told(multilaterate(of_it), stand_in, at_last);
  }
  for (const auto& [landmark, of_it] : readings.directions) {
    if (laid.landmarks[idx(landmark)]) continue;
    const Vector2 stand_in = of_it.front().from + rotation(of_it.front().direction).col(0);
    laid.landmarks[idx(landmark)] = place_told(triangulate(of_it), stand_in, at_last);
  }
  return laid;
}

}  // namespace trussmap::estimation
