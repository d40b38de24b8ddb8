// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "grid_input.hpp"

#include <algorithm>
#include <random>

namespace trussmap::bench {

Grid make_grid(int side, int repeats, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Grid grid;
  const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  grid.about.reserve(count);
  grid.measurements.reserve(2 * count * static_cast<std::size_t>(repeats));
  const auto measure = [&](int i, int j, const Vector2& along) {
    // 5 % along the route, 3 % across it, turned a little so that the covariance is full.
    const double angle = 0.3 * normal(random);
    const Matrix2 axes =
        rotation(angle) * (Matrix2() << along.x(), -along.y(), along.y(), along.x()).finished();
    const Vector2 sd(0.05, 0.03);
    const Vector2 error = axes * Vector2(sd.x() * normal(random), sd.y() * normal(random));
    const Matrix2 information =
        axes * sd.cwiseAbs2().cwiseInverse().asDiagonal() * axes.transpose();
    grid.measurements.push_back({i, j, along + error, information});
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int node = y * side + x;
      grid.about.emplace_back(x + 0.2 * normal(random), y + 0.2 * normal(random));
      for (int k = 0; k < repeats; ++k) {
        if (x + 1 < side) measure(node, node + 1, {1.0, 0.0});
        if (y + 1 < side) measure(node, node + side, {0.0, 1.0});
      }
    }
  }
  grid.about.front() = Vector2::Zero();
  std::shuffle(grid.measurements.begin(), grid.measurements.end(), random);
  return grid;
}

}  // namespace trussmap::bench
