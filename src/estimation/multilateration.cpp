// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/multilateration.hpp"

#include "estimation/robust_place.hpp"
#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace trussmap::estimation {

/// Found by robust_place through the reading's namespace.
static ReadingPull pull_of(const RangeReading& one, const Vector2& place) {
  const Vector2 way = place - one.from;
  const double distance = std::max(way.norm(), 1e-9);
  return {(distance - one.range) / one.sd, way / (distance * one.sd)};
}

std::optional<Multilateration> multilaterate(const std::vector<RangeReading>& all) {
  constexpr std::size_t kFewest = 3;
  constexpr int kDirections = 36;
  constexpr double kTold = 9.0;       // of chi^2: three standard deviations
  constexpr double kApart = 0.05;     // of the range: places closer than that are one
  constexpr double kWellKnown = 0.1;  // of the range: standard deviation along the worst direction
  if (all.size() < kFewest) return std::nullopt;
  const std::vector<RangeReading> readings = statistics::thinned(all, kMostReadings);
  const RangeReading& nearest = *std::min_element(
      readings.begin(), readings.end(),
      [](const RangeReading& a, const RangeReading& b) { return a.range < b.range; });
  double middle = 0.0;
  for (const RangeReading& one : readings)
    middle += one.range / static_cast<double>(readings.size());
  std::vector<RobustPlace> minima;
  for (int k = 0; k < kDirections; ++k) {
    const double way = 0.1 + 2.0 * std::numbers::pi * k / kDirections;  // along no axis
    minima.push_back(robust_place(
        readings, nearest.from + std::max(nearest.range, 1e-3) * rotation(way).col(0)));
  }
  const RobustPlace best =
      *std::min_element(minima.begin(), minima.end(),
                        [](const RobustPlace& a, const RobustPlace& b) { return a.cost < b.cost; });
  // Ranges that fit badly tell less.
  const double dispersion = dispersion_of(best, readings.size());
  Multilateration result;
  result.place = best.place;
  const RobustPlace* second = nullptr;
  for (const RobustPlace& one : minima) {
    if ((one.place - best.place).norm() < kApart * middle) continue;
    if (second == nullptr || one.cost < second->cost) second = &one;
  }
  if (second != nullptr && second->cost - best.cost < kTold * dispersion) {
    result.mirror = second->place;
  }
  const double weakest =
      Eigen::SelfAdjointEigenSolver<Matrix2>(best.information).eigenvalues().minCoeff();
  const double worst_sd = std::sqrt(dispersion / std::max(weakest, 1e-300));
  result.certain = !result.mirror && worst_sd < kWellKnown * middle;
  return result;
}

}  // namespace trussmap::estimation
