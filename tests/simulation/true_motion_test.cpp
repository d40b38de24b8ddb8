// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/true_motion.hpp"

#include "geometry/index.hpp"
#include "simulation/tours.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::true_motion_test {
using namespace simulation;
namespace {

using std::numbers::pi;

/// A world and a walk with everything a path may contain.
struct Field {
  Mesh mesh;
  std::vector<int> walk;
  DrivingStyle style;
};

Field field(int tours) {
  std::mt19937_64 random(31);
  Field f;
  const std::vector<double> x = random_lines(5, 3.0, 7.0, random);
  const std::vector<double> y = random_lines(4, 3.0, 7.0, random);
  f.mesh = jittered(mesh_of_lines(x, y), 0.3, random);
  f.walk = make_tours(f.mesh, WalkKind::euler, tours, random).walk;
  f.style.corner_share = 0.2;
  f.style.rest_share = 0.1;
  f.style.full_spins = 3;
  return f;
}

TEST(TrueMotion, StopsNearEveryLandmarkOfTheWalk) {
  const Field f = field(4);
  const TrueMotion motion = lay_path(f.mesh, f.walk, f.style, 1);
  ASSERT_EQ(motion.stops.size(), f.walk.size());
  double squares = 0.0;
  for (std::size_t k = 0; k < f.walk.size(); ++k) {
    const TrueStop& stop = motion.stops[k];
    EXPECT_EQ(stop.landmark, f.walk[k]);
    const TrueRow* const last = stop.rows == 0 ? nullptr : &motion.rows[stop.rows - 1];
    EXPECT_EQ(stop.t, last == nullptr ? 0.0 : last->t);
    squares += (stop.pose.position() - f.mesh.positions[idx(f.walk[k])]).squaredNorm();
  }
  // A mean of 2n squared deviates: standard deviation sqrt(1/n) of its own size.
  const auto n = static_cast<double>(f.walk.size());
  EXPECT_NEAR(squares / (2.0 * n), 25e-6, 4.0 * 25e-6 * std::sqrt(1.0 / n));
  EXPECT_EQ(motion.stops.back().rows, motion.rows.size()) << "the last row ends at the last stop";
}

TEST(TrueMotion, RowsAreArcsOfTheirSpeedAndTurnRate) {
  const Field f = field(1);
  const TrueMotion motion = lay_path(f.mesh, f.walk, f.style, 2);
  Pose pose = motion.start;
  double t = 0.0;
  for (const TrueRow& row : motion.rows) {
    ASSERT_GT(row.t, t);
    EXPECT_NEAR(row.t - t, row.duration, 1e-9);
    constexpr int steps = 1000;
    const double h = row.duration / steps;
    for (int k = 0; k < steps; ++k) {  // midpoint rule
      pose.heading += 0.5 * h * row.turn_rate;
      pose.x += h * row.speed * std::cos(pose.heading);
      pose.y += h * row.speed * std::sin(pose.heading);
      pose.heading += 0.5 * h * row.turn_rate;
    }
    ASSERT_NEAR((pose.position() - row.pose.position()).norm(), 0.0, 1e-9);
    ASSERT_NEAR(pose.heading, row.pose.heading, 1e-11);
    pose = row.pose;
    t = row.t;
  }
}

TEST(TrueMotion, KeepsToItsStyle) {
  const Field f = field(2);
  const TrueMotion motion = lay_path(f.mesh, f.walk, f.style, 3);
  bool rests = false;
  bool bends = false;
  for (const TrueRow& row : motion.rows) {
    if (row.activity == Activity::drive) {
      // A bent leg is longer than the straight one that fixed its number of rows: at most twice.
      EXPECT_GT(row.speed, 0.9 * f.style.slowest);
      EXPECT_LT(row.speed, 2.1 * f.style.fastest);
      bends = bends || std::abs(row.turn_rate) > 0.1;
    } else {
      EXPECT_EQ(row.speed, 0.0);
    }
    rests = rests || row.activity == Activity::rest;
    EXPECT_EQ(row.activity == Activity::spin, row.speed == 0.0 && row.turn_rate != 0.0);
  }
  EXPECT_TRUE(rests);
  EXPECT_TRUE(bends);
}

/// Angles turned without a change of rate, rad.
std::vector<double> spins(const TrueMotion& motion) {
  std::vector<double> angles;
  double rate = 0.0;
  for (const TrueRow& row : motion.rows) {
    if (row.activity == Activity::spin && row.turn_rate != rate) angles.push_back(0.0);
    rate = row.activity == Activity::spin ? row.turn_rate : 0.0;
    if (row.activity == Activity::spin) angles.back() += row.turn_rate * row.duration;
  }
  return angles;
}

TEST(TrueMotion, FullSpinsTurnTwiceBothWays) {
  const Field f = field(1);
  int left = 0;
  int right = 0;
  for (const double angle : spins(lay_path(f.mesh, f.walk, f.style, 4))) {
    left += std::abs(angle - 4.0 * pi) < 1e-9 ? 1 : 0;
    right += std::abs(angle + 4.0 * pi) < 1e-9 ? 1 : 0;
    EXPECT_LE(std::abs(angle), 4.0 * pi + 1e-9);
    EXPECT_TRUE(std::abs(angle) <= pi + 1e-9 || std::abs(angle) > 12.0) << "the short way round";
  }
  EXPECT_EQ(left, f.style.full_spins);
  EXPECT_EQ(right, f.style.full_spins);
}

TEST(TrueMotion, StraightLegsAreStraight) {
  Field f = field(1);
  f.style.bend = 0.0;
  f.style.corner_share = 0.0;
  for (const TrueRow& row : lay_path(f.mesh, f.walk, f.style, 5).rows) {
    if (row.activity == Activity::drive) {
      EXPECT_NEAR(row.turn_rate, 0.0, 1e-12);
    }
  }
}

TEST(TrueMotion, SurroundingsVaryBetweenLegsOnly) {
  const Field f = field(2);
  const TrueMotion motion = lay_path(f.mesh, f.walk, f.style, 6);
  int changes = 0;
  std::size_t stop = 1;
  for (std::size_t k = 1; k < motion.rows.size(); ++k) {
    while (motion.stops[stop].rows < k) ++stop;
    const Surroundings& before = motion.rows[k - 1].surroundings;
    const Surroundings& now = motion.rows[k].surroundings;
    const bool changed = now.payload_kg != before.payload_kg || now.lights != before.lights;
    if (changed) {
      EXPECT_EQ(motion.stops[stop].rows, k) << "row " << k;
    }
    changes += changed ? 1 : 0;
    EXPECT_LT(std::abs(now.temperature_C - before.temperature_C), 0.01);
  }
  // A leg keeps both with probability (1 - 0.7 * 3/4) * 0.5 = 0.24: n legs, 4 standard deviations.
  const auto n = static_cast<double>(motion.stops.size() - 2);
  EXPECT_NEAR(changes, 0.7625 * n, 4.0 * std::sqrt(0.7625 * 0.2375 * n));
}

TEST(TrueMotion, IsDrawnFromItsSeed) {
  const Field f = field(1);
  const TrueMotion motion = lay_path(f.mesh, f.walk, f.style, 7);
  const TrueMotion same = lay_path(f.mesh, f.walk, f.style, 7);
  const TrueMotion other = lay_path(f.mesh, f.walk, f.style, 8);
  ASSERT_EQ(motion.rows.size(), same.rows.size());
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    ASSERT_EQ(motion.rows[k].pose.x, same.rows[k].pose.x);
    ASSERT_EQ(motion.rows[k].pose.heading, same.rows[k].pose.heading);
  }
  EXPECT_NE(motion.stops[1].pose.x, other.stops[1].pose.x);
  EXPECT_NE(motion.stops[1].t, other.stops[1].t);
}

TEST(TrueMotion, RefusesWhatCannotBeDriven) {
  const Field f = field(1);
  const auto refuses = [&](const std::vector<int>& walk, const DrivingStyle& style) {
    EXPECT_THROW((void)lay_path(f.mesh, walk, style, 1), std::invalid_argument);
  };
  refuses({0}, f.style);
  refuses({0, 0}, f.style);
  refuses({0, 20}, f.style);
  refuses({0, -1}, f.style);
  for (const auto spoil : std::vector<void (*)(DrivingStyle&)>{
           [](DrivingStyle& s) { s.row_duration = 0.0; }, [](DrivingStyle& s) { s.slowest = 2.0; },
           [](DrivingStyle& s) { s.fastest_turn = std::nan(""); },
           [](DrivingStyle& s) { s.bend = 0.6; }, [](DrivingStyle& s) { s.corner_share = 1.1; },
           [](DrivingStyle& s) { s.corner_reach = -0.1; },
           [](DrivingStyle& s) { s.longest_rest = 1.0; },
           [](DrivingStyle& s) { s.full_spins = -1; }, [](DrivingStyle& s) { s.standing = -1.0; },
           [](DrivingStyle& s) { s.standing = 1.0; }}) {
    DrivingStyle style;
    spoil(style);
    refuses({0, 1}, style);
  }
}

}  // namespace
}  // namespace trussmap::true_motion_test
