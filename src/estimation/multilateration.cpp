// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/multilateration.hpp"

#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

double cost_at(const std::vector<RangeReading>& readings, const Vector2& place) {
  double sum = 0.0;
  for (const RangeReading& one : readings) {
    sum += rho(((place - one.from).norm() - one.range) / one.sd);
  }
  return sum;
}

/// Gauss-Newton with damping from there.
Minimum descend(const std::vector<RangeReading>& readings, const Vector2& place) {
  constexpr int kMostSteps = 60;
  double damping = 1e-3;
  Minimum result{place, cost_at(readings, place)};
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix2 A = Matrix2::Zero();
    Vector2 b = Vector2::Zero();
    for (const RangeReading& one : readings) {
      const Vector2 way = result.place - one.from;
      const double distance = std::max(way.norm(), 1e-9);
      const double z = (distance - one.range) / one.sd;
      const double weight = std::abs(z) <= kHuber ? 1.0 : kHuber / std::abs(z);
      const Vector2 g = way / (distance * one.sd);
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

}  // namespace

std::optional<Multilateration> multilaterate(const std::vector<RangeReading>& all) {
  constexpr std::size_t kFewest = 3;
  constexpr int kDirections = 36;
  constexpr double kTold = 9.0;       // of chi^2: three standard deviations
  constexpr double kApart = 0.05;     // of the range: places closer than that are one
  constexpr double kWellKnown = 0.1;  // of the range: standard deviation along the worst direction
  if (all.size() < kFewest) return std::nullopt;
  const std::vector<RangeReading> readings = thinned(all, kMostReadings);
  const RangeReading& nearest = *std::min_element(
      readings.begin(), readings.end(),
      [](const RangeReading& a, const RangeReading& b) { return a.range < b.range; });
  double middle = 0.0;
  for (const RangeReading& one : readings)
    middle += one.range / static_cast<double>(readings.size());
  std::vector<Minimum> minima;
  for (int k = 0; k < kDirections; ++k) {
    const double way = 0.1 + 2.0 * std::numbers::pi * k / kDirections;  // along no axis
    minima.push_back(
        descend(readings, nearest.from + std::max(nearest.range, 1e-3) * rotation(way).col(0)));
  }
  const Minimum best =
      *std::min_element(minima.begin(), minima.end(),
                        [](const Minimum& a, const Minimum& b) { return a.cost < b.cost; });
  // Ranges that fit badly tell less.
  const double dispersion =
      std::max(1.0, best.cost / static_cast<double>(std::max<std::size_t>(readings.size() - 2, 1)));
  Multilateration result;
  result.place = best.place;
  const Minimum* second = nullptr;
  for (const Minimum& one : minima) {
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

}  // namespace trussmap
