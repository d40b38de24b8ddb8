// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A place by readings of one kind, robustly: what multilateration and triangulation share.
//
//   minimise over p   sum of rho(z_k(p))     z: a reading's error, standard deviations
//
// with rho square within two standard deviations and linear beyond (Huber). A reading type has an
// overload pull_of(reading, p): z and its gradient there.
#pragma once

#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/LU>

namespace trussmap::estimation {

inline constexpr std::size_t kMostReadings = 150;  ///< more are thinned
inline constexpr double kHuber = 2.0;              ///< standard deviations

struct ReadingPull {
  double z = 0.0;                      ///< predicted less measured, standard deviations
  Vector2 gradient = Vector2::Zero();  ///< 1/m
};

struct RobustPlace {
  Vector2 place = Vector2::Zero();  ///< m
  double cost = 0.0;
  Matrix2 information = Matrix2::Zero();  ///< 1/m^2
};

template <typename Reading>
[[nodiscard]] double robust_cost(const std::vector<Reading>& readings, const Vector2& place) {
  double sum = 0.0;
  for (const Reading& one : readings) {
    const double size = std::abs(pull_of(one, place).z);
    sum += size <= kHuber ? size * size : kHuber * (2.0 * size - kHuber);
  }
  return sum;
}

/// Gauss-Newton with damping from there.
template <typename Reading>
[[nodiscard]] RobustPlace robust_place(const std::vector<Reading>& readings, const Vector2& start) {
  constexpr int kMostSteps = 60;
  double damping = 1e-3;
  RobustPlace result{start, robust_cost(readings, start)};
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix2 A = Matrix2::Zero();
    Vector2 b = Vector2::Zero();
    for (const Reading& one : readings) {
      const auto [z, g] = pull_of(one, result.place);
      const double weight = std::abs(z) <= kHuber ? 1.0 : kHuber / std::abs(z);
      A += weight * g * g.transpose();
      b -= weight * z * g;
    }
    result.information = A;
    const Matrix2 damped = A + damping * (A.trace() + 1e-12) * Matrix2::Identity();
    const Vector2 move = damped.inverse() * b;
    const double cost = robust_cost(readings, result.place + move);
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

/// By how much readings that fit badly tell less: chi^2/dof of them, 1 at least.
[[nodiscard]] inline double dispersion_of(const RobustPlace& best, std::size_t readings) {
  return std::max(1.0, best.cost / static_cast<double>(std::max<std::size_t>(readings, 3) - 2));
}

}  // namespace trussmap::estimation
