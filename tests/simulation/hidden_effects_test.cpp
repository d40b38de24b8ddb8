// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/hidden_effects.hpp"

#include "simulation/effect_gains.hpp"
#include "simulation/motion_variables.hpp"
#include "simulation/tours.hpp"
#include "simulation/true_motion.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::hidden_effects_test {
using namespace simulation;
namespace {

struct Field {
  Mesh mesh;
  TrueMotion motion;
  WheeledRobot robot;
};

Field field() {
  Field f;
  std::mt19937_64 random(41);
  f.mesh = even_mesh({5, 5}, 5.0);
  f.motion = lay_path(f.mesh, make_tours(f.mesh, WalkKind::euler, 1, random).walk, {}, 2);
  return f;
}

TEST(HiddenEffects, AreOneOrTwoThatTheRecordingCanShow) {
  const Field f = field();
  std::set<std::string> names;
  int twos = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::vector<Effect> drawn = draw_hidden_effects(f.motion, f.mesh, f.robot, true, seed);
    ASSERT_TRUE(drawn.size() == 1 || drawn.size() == 2);
    twos += drawn.size() == 2 ? 1 : 0;
    for (const Effect& effect : drawn) {
      const CatalogueEntry* entry = find_entry(effect.name);
      ASSERT_NE(entry, nullptr) << effect.name;
      names.insert(std::string(entry->name));
      EXPECT_EQ(effect.channel, entry->channel);
      EXPECT_EQ(effect.coefficients.size(), effect.shape.size());
      EXPECT_FALSE(effect.channel == Channel::range || effect.channel == Channel::range_scale ||
                   effect.channel == Channel::bearing);
    }
    if (drawn.size() == 2) {
      EXPECT_NE(drawn[0].channel, drawn[1].channel);
    }
  }
  EXPECT_GT(names.size(), 15U);
  // 80 of 200 expected; 4 sqrt(200 x 0.4 x 0.6) = 28.
  EXPECT_NEAR(twos, 80, 28);
}

TEST(HiddenEffects, KeepToWhatTheRobotHas) {
  Field f = field();
  f.robot.compass = false;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const Effect& effect : draw_hidden_effects(f.motion, f.mesh, f.robot, false, seed)) {
      EXPECT_NE(effect.channel, Channel::compass);
      EXPECT_NE(effect.name, "travel scale");
      EXPECT_NE(effect.name, "constant creep");
    }
  }
}

/// A turned camera shows where there are markers and a survey, and there alone.
TEST(HiddenEffects, AYawOffsetNeedsMarkersAndASurvey) {
  Field f = field();
  const auto drawn = [&](bool surveyed, std::uint64_t seeds) {
    int count = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      for (const Effect& effect : draw_hidden_effects(f.motion, f.mesh, f.robot, surveyed, seed)) {
        count += effect.channel == Channel::sighting_yaw ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_EQ(drawn(true, 40), 0);
  f.robot.markers = true;
  EXPECT_GT(drawn(true, 150), 0);
  EXPECT_EQ(drawn(false, 40), 0);
}

TEST(HiddenEffects, AreDrawnFromTheirSeed) {
  const Field f = field();
  const std::vector<Effect> a = draw_hidden_effects(f.motion, f.mesh, f.robot, true, 7);
  const std::vector<Effect> b = draw_hidden_effects(f.motion, f.mesh, f.robot, true, 7);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].name, b[k].name);
    EXPECT_EQ(a[k].coefficients, b[k].coefficients);
  }
}

TEST(HiddenEffects, AreOfASizeThatShowsAndThatARobotMayHave) {
  const Field f = field();
  const MotionVariables variables =
      motion_variables(f.motion, true_rates(f.motion), f.robot.geometry.wheelbase);
  const double legs = static_cast<double>(f.motion.stops.size()) - 1.0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const Effect& effect : draw_hidden_effects(f.motion, f.mesh, f.robot, true, seed)) {
      const CatalogueEntry* entry = find_entry(effect.name);
      const std::vector<double> g = channel_gains({effect}, variables).at(entry->channel);
      const auto [least, most] = std::minmax_element(g.begin(), g.end());
      const double largest =
          entry->of_covariate() ? *most - *least : std::max(std::abs(*least), std::abs(*most));
      const double times = largest / (entry->detectable * std::max(1.0, std::sqrt(60.0 / legs)));
      EXPECT_GT(times, 2.99) << effect.name;
      EXPECT_LT(times, 6.01) << effect.name;
      EXPECT_LT(largest, 3.0 * entry->prior_sd()) << effect.name;
    }
  }
}

}  // namespace
}  // namespace trussmap::hidden_effects_test
