// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map builder whose groups move at every scale, their landmarks unseen: whatever is asked of it
// is as if each had been moved at once. Judges: a builder that goes on from its memory, whose
// landmarks all lie where they are; one that does not refine; all landmarks looked through.
#include "geometry/index.hpp"
#include "map/builder_memory.hpp"
#include "trussmap/map_builder.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::every_scale_test {
namespace {

constexpr int kSide = 12;

struct Drive {
  std::string to;
  Traversal leg;
};

/// A random way over a grid, biased so that it comes round.
std::vector<Drive> drives(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Drive> result;
  int x = 0;
  int y = 0;
  while (static_cast<int>(result.size()) < count) {
    const int step = random() % 2 == 0 ? 1 : -1;
    const bool along_x = random() % 2 == 0;
    const int nx = along_x ? x + step : x;
    const int ny = along_x ? y : y + step;
    if (nx < 0 || ny < 0 || nx >= kSide || ny >= kSide) continue;
    const Vector2 along(nx - x, ny - y);
    const Matrix2 axes = (Matrix2() << along.x(), -along.y(), along.y(), along.x()).finished();
    const Vector2 sd(0.06, 0.03);
    const Vector2 error = axes * Vector2(sd.x() * normal(random), sd.y() * normal(random));
    result.push_back({std::to_string(ny * kSide + nx),
                      {along + error, axes * sd.cwiseAbs2().asDiagonal() * axes.transpose()}});
    x = nx;
    y = ny;
  }
  return result;
}

MapBuilderOptions every_scale() {
  return {.scope = {RefinementScope::Kind::nearest, 6, true},
          .gate = std::numeric_limits<double>::infinity()};
}

MapBuilder gone_on(const MapBuilder& builder, const MapBuilderOptions& options) {
  return BuilderAccess::restored(BuilderAccess::settled_memory(builder), options);
}

double largest_difference(const MapBuilder& a, const MapBuilder& b) {
  double off = 0.0;
  for (int k = 0; k < a.landmarks(); ++k)
    off = std::max(off, (a.position(k) - b.position(k)).norm());
  return off;
}

TEST(EveryScale, OneThatGoesOnFromTheMemoryIsAsOneThatNeverStopped) {
  const std::vector<Drive> legs = drives(900, 1);
  MapBuilder builder(every_scale());
  MapBuilder twin(every_scale());
  builder.start("0");
  twin.start("0");
  std::vector<MapBuilder> later;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    builder.arrive(legs[k].to, legs[k].leg);
    twin.arrive(legs[k].to, legs[k].leg);
    for (MapBuilder& one : later) one.arrive(legs[k].to, legs[k].leg);
    if (k % 200 == 150) later.push_back(gone_on(builder, every_scale()));
    ASSERT_EQ(largest_difference(builder, twin), 0.0) << k;
    for (const MapBuilder& one : later) ASSERT_LE(largest_difference(builder, one), 1e-8) << k;
  }
  ASSERT_GT(builder.landmarks(), 100);
}

TEST(EveryScale, TheEnergyNeverRises) {
  const std::vector<Drive> legs = drives(700, 2);
  MapBuilderOptions still = every_scale();
  still.refine = false;
  MapBuilder builder(every_scale());
  builder.start("0");
  double fell = 0.0;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    MapBuilder unrefined = gone_on(builder, still);
    ASSERT_NEAR(unrefined.energy(), builder.energy(), 1e-9 * (1.0 + builder.energy())) << k;
    unrefined.arrive(legs[k].to, legs[k].leg);
    builder.arrive(legs[k].to, legs[k].leg);
    ASSERT_LE(builder.energy(), unrefined.energy() * (1.0 + 1e-10) + 1e-15) << k;
    fell += unrefined.energy() - builder.energy();
  }
  EXPECT_GT(fell, 1.0);
}

TEST(EveryScale, IsNearTheEquilibriumOfAll) {
  MapBuilder builder(every_scale());
  builder.start("0");
  for (const Drive& one : drives(4000, 3)) builder.arrive(one.to, one.leg);
  MapBuilder settled = gone_on(builder, every_scale());
  settled.relax();
  EXPECT_LE(builder.energy(), 1.03 * settled.energy());
  MapBuilderOptions alone = every_scale();
  alone.scope.groups = false;
  MapBuilder pieces(alone);
  pieces.start("0");
  for (const Drive& one : drives(4000, 3)) pieces.arrive(one.to, one.leg);
  EXPECT_GT(pieces.energy() - settled.energy(), 3.0 * (builder.energy() - settled.energy()));
}

TEST(EveryScale, AllThatIsAskedKnowsWhereLandmarksAre) {
  MapBuilder builder(every_scale());
  builder.start("0");
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> anywhere(-1.0, kSide);
  for (const Drive& one : drives(600, 4)) {
    builder.arrive(one.to, one.leg);
    const LandmarkGraph map = builder.map();
    const Vector2 point(anywhere(random), anywhere(random));
    std::vector<int> order(idx(builder.landmarks()));
    std::iota(order.begin(), order.end(), 0);
    for (const int k : order) ASSERT_EQ(map.landmark(k).position, builder.position(k));
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return (map.landmark(a).position - point).norm() < (map.landmark(b).position - point).norm();
    });
    order.resize(std::min<std::size_t>(order.size(), 9));
    ASSERT_EQ(builder.nearest(point, 9), order);
  }
}

TEST(EveryScale, AnotherScopeGoesOnWhereItStopped) {
  using Kind = RefinementScope::Kind;
  const std::vector<Drive> legs = drives(1200, 5);
  const std::vector<RefinementScope> scopes{
      {Kind::nearest, 6, true}, {Kind::all}, {Kind::nearest, 8, false}, {Kind::estimated, 6, true}};
  MapBuilder builder(every_scale());
  builder.start("0");
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (k % 60 == 59) {
      MapBuilderOptions options = every_scale();
      options.scope = scopes[(k / 60) % scopes.size()];
      MapBuilder copy = gone_on(builder, options);
      builder.set_options(options);
      builder.arrive(legs[k].to, legs[k].leg);
      copy.arrive(legs[k].to, legs[k].leg);
      ASSERT_LE(largest_difference(builder, copy), 1e-8) << k;
      continue;
    }
    builder.arrive(legs[k].to, legs[k].leg);
  }
  const LandmarkGraph before = builder.map();
  builder.compass(0.4, 0.1);  // these legs are in map axes: nothing turns
  for (int k = 0; k < builder.landmarks(); ++k) {
    EXPECT_EQ(builder.position(k), before.landmark(k).position);
  }
  EXPECT_LE(builder.relax(), 1.0);
}

TEST(EveryScale, LegsInTheRobotsOwnAxesTakeOver) {
  MapBuilder builder(every_scale());
  builder.start("0");
  const std::vector<Drive> legs = drives(500, 6);
  for (const Drive& one : legs) builder.arrive(one.to, one.leg);
  const std::string here = builder.name(builder.here());
  MapBuilder copy = gone_on(builder, every_scale());
  for (MapBuilder* one : {&builder, &copy}) {
    one->start(here);
    one->compass(0.0, 0.01);
    Motion motion;
    motion.displacement = {0.9, 0.1, 0.0};
    motion.covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
    one->arrive("a new one", motion);
    one->arrive(here, Traversal{{-0.9, -0.1}, 1e-3 * Matrix2::Identity()});
  }
  EXPECT_LE(largest_difference(builder, copy), 1e-8);
  EXPECT_NEAR(builder.energy(), copy.energy(), 1e-8 * copy.energy());
}

}  // namespace
}  // namespace trussmap::every_scale_test
