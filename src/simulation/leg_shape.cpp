// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/leg_shape.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trussmap::simulation {

Vector2 unit_step(double first, double last) {
  constexpr std::array<double, 5> kNodes = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                            0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 5> kWeights = {0.2369268850561891, 0.4786286704993665,
                                              0.5688888888888889, 0.4786286704993665,
                                              0.2369268850561891};
  Vector2 sum = Vector2::Zero();
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const double heading = 0.5 * (first + last) + 0.5 * (last - first) * kNodes[k];
    sum += 0.5 * kWeights[k] * Vector2(std::cos(heading), std::sin(heading));
  }
  return sum;
}

std::vector<double> speed_profile(int rows, int ramp_rows) {
  std::vector<double> profile(idx(rows), 1.0);
  if (ramp_rows == 0) return profile;
  double sum = 0.0;
  for (int k = 0; k < rows; ++k) {
    profile[idx(k)] = std::min({1.0, (k + 0.5) / ramp_rows, (rows - k - 0.5) / ramp_rows});
    sum += profile[idx(k)];
  }
  for (double& share : profile) share *= rows / sum;
  return profile;
}

LegShape leg_shape(const std::array<double, 3>& bends, const std::vector<double>& profile,
                   Bends even) {
  const int rows = static_cast<int>(profile.size());
  LegShape shape;
  double gone = 0.0;
  for (int k = 0; k <= rows; ++k) {
    const double u = even == Bends::in_time ? static_cast<double>(k) / rows : gone;
    if (k < rows) gone += profile[idx(k)] / rows;
    shape.headings.push_back(bends[0] * std::sin(2.0 * std::numbers::pi * u) +
                             bends[1] * std::cos(std::numbers::pi * u) +
                             bends[2] * std::cos(2.0 * std::numbers::pi * u));
    if (k == 0) continue;
    shape.end +=
        unit_step(shape.headings[idx(k - 1)], shape.headings[idx(k)]) * profile[idx(k - 1)] / rows;
  }
  return shape;
}

double sharpest_bend(const std::array<double, 3>& bends) {
  return std::numbers::pi *
         (2.0 * std::abs(bends[0]) + std::abs(bends[1]) + 2.0 * std::abs(bends[2]));
}

}  // namespace trussmap::simulation
