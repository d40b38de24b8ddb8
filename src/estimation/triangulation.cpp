// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/triangulation.hpp"

#include "estimation/robust_place.hpp"
#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace trussmap::estimation {

/// Found by robust_place through the reading's namespace.
static ReadingPull pull_of(const DirectionReading& one, const Vector2& place) {
  const Vector2 way = place - one.from;
  return {wrap_angle(direction(way) - one.direction) / one.sd,
          quarter_turn(way) / (std::max(way.squaredNorm(), 1e-12) * one.sd)};
}

namespace {

/// Where two sights cross ahead of both; nothing where they do not.
std::optional<Vector2> crossing(const DirectionReading& a, const DirectionReading& b) {
  constexpr double kParallel = 1e-3;
  const Vector2 along = rotation(a.direction).col(0);
  const Vector2 other = rotation(b.direction).col(0);
  const double sine = along.x() * other.y() - along.y() * other.x();
  if (std::abs(sine) < kParallel) return std::nullopt;
  const Vector2 between = b.from - a.from;
  const double way = (between.x() * other.y() - between.y() * other.x()) / sine;
  const double way_b = (between.x() * along.y() - between.y() * along.x()) / sine;
  if (way <= 0.0 || way_b <= 0.0) return std::nullopt;
  return a.from + way * along;
}

}  // namespace

std::optional<Triangulation> triangulate(const std::vector<DirectionReading>& all) {
  constexpr std::size_t kFewest = 2;
  constexpr std::size_t kCrossings = 12;
  constexpr double kWellKnown = 0.1;  // of the distance: standard deviation in the worst direction
  if (all.size() < kFewest) return std::nullopt;
  const std::vector<DirectionReading> readings = statistics::thinned(all, kMostReadings);
  std::vector<Vector2> starts;
  for (const DirectionReading& one : statistics::thinned(readings, kCrossings)) {
    for (const DirectionReading& other : statistics::thinned(readings, kCrossings)) {
      if (const std::optional<Vector2> at = crossing(one, other)) starts.push_back(*at);
    }
  }
  for (const double way : {1.0, 3.0, 10.0, 30.0}) {
    starts.emplace_back(readings.front().from + way * rotation(readings.front().direction).col(0));
  }
  RobustPlace best;
  bool found = false;
  for (const Vector2& start : starts) {
    const RobustPlace one = robust_place(readings, start);
    if (found && one.cost >= best.cost) continue;
    best = one;
    found = true;
  }
  double nearest = (best.place - readings.front().from).norm();
  for (const DirectionReading& one : readings) {
    nearest = std::min(nearest, (best.place - one.from).norm());
  }
  const double dispersion = dispersion_of(best, readings.size());
  const double weakest =
      Eigen::SelfAdjointEigenSolver<Matrix2>(best.information).eigenvalues().minCoeff();
  if (!(weakest > 0.0)) return std::nullopt;
  Triangulation result;
  result.place = best.place;
  result.certain = std::sqrt(dispersion / weakest) < kWellKnown * nearest;
  return result;
}

}  // namespace trussmap::estimation
