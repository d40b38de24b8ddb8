// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/triangulation.hpp"

#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr std::size_t kMostReadings = 150;
constexpr double kHuber = 2.0;  // standard deviations

struct Minimum {
  Vector2 place = Vector2::Zero();
  double cost = 0.0;
  Matrix2 information = Matrix2::Zero();
};

double rho(double z) {
  const double size = std::abs(z);
  return size <= kHuber ? z * z : kHuber * (2.0 * size - kHuber);
}

double miss(const DirectionReading& one, const Vector2& place) {
  return wrap_angle(direction(place - one.from) - one.direction) / one.sd;
}

double cost_at(const std::vector<DirectionReading>& readings, const Vector2& place) {
  double sum = 0.0;
  for (const DirectionReading& one : readings) sum += rho(miss(one, place));
  return sum;
}

/// Gauss-Newton with damping from there.
Minimum descend(const std::vector<DirectionReading>& readings, const Vector2& place) {
  constexpr int kMostSteps = 60;
  double damping = 1e-3;
  Minimum result{place, cost_at(readings, place)};
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix2 A = Matrix2::Zero();
    Vector2 b = Vector2::Zero();
    for (const DirectionReading& one : readings) {
      const Vector2 way = result.place - one.from;
      const double z = miss(one, result.place);
      const double weight = std::abs(z) <= kHuber ? 1.0 : kHuber / std::abs(z);
      const Vector2 g = quarter_turn(way) / (std::max(way.squaredNorm(), 1e-12) * one.sd);
      A += weight * g * g.transpose();
      b -= weight * z * g;
    }
    result.information = A;
    const Matrix2 damped = A + damping * (A.trace() + 1e-12) * Matrix2::Identity();
    const Vector2 move = damped.inverse() * b;
    const double cost = cost_at(readings, result.place + move);
    if (cost < result.cost) {
      result.place += move;
      const bool still = result.cost - cost < 1e-9 * (1.0 + cost);
      result.cost = cost;
      damping = std::max(damping / 4.0, 1e-9);
      if (still) break;
    } else {
      damping *= 8.0;
      if (damping > 1e6) break;
    }
  }
  return result;
}

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
  const std::vector<DirectionReading> readings = thinned(all, kMostReadings);
  std::vector<Vector2> starts;
  for (const DirectionReading& one : thinned(readings, kCrossings)) {
    for (const DirectionReading& other : thinned(readings, kCrossings)) {
      if (const std::optional<Vector2> at = crossing(one, other)) starts.push_back(*at);
    }
  }
  for (const double way : {1.0, 3.0, 10.0, 30.0}) {
    starts.emplace_back(readings.front().from + way * rotation(readings.front().direction).col(0));
  }
  Minimum best;
  bool found = false;
  for (const Vector2& start : starts) {
    const Minimum one = descend(readings, start);
    if (found && one.cost >= best.cost) continue;
    best = one;
    found = true;
  }
  double nearest = (best.place - readings.front().from).norm();
  for (const DirectionReading& one : readings) {
    nearest = std::min(nearest, (best.place - one.from).norm());
  }
  const double dispersion =
      std::max(1.0, best.cost / static_cast<double>(std::max<std::size_t>(readings.size() - 2, 1)));
  const double weakest =
      Eigen::SelfAdjointEigenSolver<Matrix2>(best.information).eigenvalues().minCoeff();
  if (!(weakest > 0.0)) return std::nullopt;
  Triangulation result;
  result.place = best.place;
  result.certain = std::sqrt(dispersion / weakest) < kWellKnown * nearest;
  return result;
}

}  // namespace trussmap
