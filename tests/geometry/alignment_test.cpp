// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/planar.hpp"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::alignment_test {
namespace {

std::vector<Vector2> cloud(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector2> points;
  for (int k = 0; k < 12; ++k) points.emplace_back(5.0 * normal(random) + 100.0, normal(random));
  return points;
}

double rms_of(const Alignment& alignment, const std::vector<Vector2>& points,
              const std::vector<Vector2>& onto) {
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    sum += (alignment.apply(points[k]) - onto[k]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(Alignment, FindsTheMotionThatWasMade) {
  const std::vector<Vector2> points = cloud(1);
  const Alignment made{1.7, -2.5, {3.0, -8.0}, 0.0};
  std::vector<Vector2> onto;
  for (const Vector2& point : points) onto.push_back(made.apply(point));
  const Alignment found = align_by_similarity(points, onto);
  EXPECT_NEAR(found.scale, made.scale, 1e-13);
  EXPECT_NEAR(found.angle, made.angle, 1e-13);
  EXPECT_LE(found.rms, 1e-12);
  EXPECT_GT(align_rigidly(points, onto).rms, 1.0);
}

/// No small change of angle, shift or scale does better.
TEST(Alignment, IsTheBest) {
  const std::vector<Vector2> points = cloud(2);
  const std::vector<Vector2> onto = cloud(3);
  for (const bool scaled : {false, true}) {
    const Alignment best = scaled ? align_by_similarity(points, onto) : align_rigidly(points, onto);
    EXPECT_NEAR(best.rms, rms_of(best, points, onto), 1e-12);
    for (const double step : {-1e-3, 1e-3}) {
      Alignment other = best;
      other.angle += step;
      EXPECT_GT(rms_of(other, points, onto), best.rms);
      other = best;
      other.translation.x() += step;
      EXPECT_GT(rms_of(other, points, onto), best.rms);
      other = best;
      other.scale += step;
      if (scaled) {
        EXPECT_GT(rms_of(other, points, onto), best.rms);
      }
    }
  }
}

TEST(Alignment, RefusesWhatHasNone) {
  const std::vector<Vector2> one{{1.0, 2.0}};
  const std::vector<Vector2> same(3, Vector2(0.1, 0.7));  // whose mean is not quite 0.1, 0.7
  EXPECT_THROW((void)align_rigidly(one, one), std::invalid_argument);
  EXPECT_THROW((void)align_by_similarity(same, {{0.0, 0.0}, {1.0, 0.0}, {2.0, 5.0}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::alignment_test
