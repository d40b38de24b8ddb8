// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Squares driven by the simulated robot, as the calibration reads them.
#pragma once

#include "trussmap/simulation.hpp"
#include "trussmap/umbmark.hpp"

#include <random>

namespace trussmap::testing {

inline SquareRuns simulated_runs(const TapeRobot& robot, double side, int runs,
                                 std::mt19937_64& random) {
  SquareRuns result;
  for (const Pose& end : drive_often(robot, square_path(side, Direction::cw), runs, random)) {
    result.cw.push_back(end.position());
  }
  for (const Pose& end : drive_often(robot, square_path(side, Direction::ccw), runs, random)) {
    result.ccw.push_back(end.position());
  }
  return result;
}

inline SquareClusters simulated_clusters(const TapeRobot& robot, double side) {
  std::mt19937_64 unused;
  return square_clusters(simulated_runs(robot, side, 2, unused));
}

/// Centres of gravity alone, without scatter.
inline SquareClusters centres(const Eigen::Vector2d& cw, const Eigen::Vector2d& ccw) {
  return square_clusters({{cw, cw}, {ccw, ccw}});
}

}  // namespace trussmap::testing
