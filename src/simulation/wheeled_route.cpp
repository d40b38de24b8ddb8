// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

constexpr double kTurnPerRow = 0.2;  // rad
constexpr double kWayPerRow = 0.25;  // m

}  // namespace

std::vector<DrivenRow> drive_route(double turn, double length, double wheelbase, double noise,
                                   std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<DrivenRow> rows;
  const auto drive = [&](double left, double right, int count) {
    for (int row = 0; row < count; ++row) {
      const double l = left / count;
      const double r = right / count;
      const double seen_left = l + noise * std::sqrt(std::abs(l)) * normal(random);
      const double seen_right = r + noise * std::sqrt(std::abs(r)) * normal(random);
      rows.push_back({seen_left, seen_right});
    }
  };
  const double half = 0.5 * turn * wheelbase;
  if (turn != 0.0) {
    drive(-half, half, std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kTurnPerRow))));
  }
  drive(length, length, std::max(1, static_cast<int>(std::ceil(length / kWayPerRow))));
  return rows;
}

}  // namespace trussmap
