// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a conversion of logs is made of: paths, units, times, frames, signals, the tangent plane.
#include "logs/calendar.hpp"
#include "logs/field_path.hpp"
#include "logs/frame_tree.hpp"
#include "logs/signal.hpp"
#include "logs/tangent_plane.hpp"
#include "logs/units.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::log_pieces_test {
using namespace logs;
namespace {

constexpr std::int64_t kSecond = 1000000000;

/// name ["l", "r"], position [1, 2], markers [{id 5, x 7}, {id 6, x 8}], a.b 3
FieldTree sample_tree() {
  FieldTree tree;
  const std::size_t root = tree.open_group("");
  const std::size_t names = tree.open_list("name", 2);
  tree.add_text("", "l");
  tree.add_text("", "r");
  tree.close(names);
  const std::size_t positions = tree.open_list("position", 2);
  tree.add_number("", 1.0);
  tree.add_number("", 2.0);
  tree.close(positions);
  const std::size_t markers = tree.open_list("markers", 2);
  for (const int id : {5, 6}) {
    const std::size_t marker = tree.open_group("");
    tree.add_integer("id", id);
    tree.add_number("x", id + 2.0);
    tree.close(marker);
  }
  tree.close(markers);
  const std::size_t a = tree.open_group("a");
  tree.add_number("b", 3.0);
  tree.close(a);
  tree.close(root);
  return tree;
}

TEST(FieldPath, LeadsToMembersElementsFellowsAndKeys) {
  const FieldTree tree = sample_tree();
  const auto number = [&](const char* path) {
    const auto found = FieldPath(path, false).find(tree.root());
    return found ? found->number() : -1.0;
  };
  EXPECT_EQ(number("a.b"), 3.0);
  EXPECT_EQ(number("position[1]"), 2.0);
  EXPECT_EQ(number("position[l]"), 1.0);
  EXPECT_EQ(number("position[r]"), 2.0);
  EXPECT_EQ(number("markers[id=6].x"), 8.0);
  EXPECT_EQ(number("markers[0].x"), 7.0);
  for (const char* none : {"position[2]", "position[x]", "markers[id=7].x", "a.c", "b", "a.b.c"}) {
    EXPECT_EQ(number(none), -1.0) << none;
  }
  EXPECT_TRUE(FieldPath(".", false).is_empty());
  for (const char* wrong : {"a[", "a[]", "a..b", "[0]."}) {
    EXPECT_THROW(FieldPath(wrong, false), std::invalid_argument) << wrong;
  }
}

TEST(FieldPath, AColumnMayHaveAnyCharacters) {
  FieldTree tree;
  const std::size_t root = tree.open_group("");
  tree.add_number("a.b [mm]", 4.0);
  tree.close(root);
  const auto found = FieldPath("a.b [mm]", true).find(tree.root());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->number(), 4.0);
}

TEST(FieldPath, BelongsToItsTopicAlone) {
  LogTopic topic;
  topic.name = "/odom";
  EXPECT_TRUE(is_of_topic("/odom/pose.x", topic));
  EXPECT_TRUE(is_of_topic("/odom", topic));
  EXPECT_FALSE(is_of_topic("/odometry/x", topic));
  EXPECT_FALSE(is_of_topic("/odo", topic));
}

TEST(FieldPath, LeavesHaveThePathsThatLeadToThem) {
  const FieldTree tree = sample_tree();
  const std::vector<NamedField> leaves = leaves_of(tree.root(), 4);
  EXPECT_EQ(leaves.size(), 9U);
  for (const NamedField& one : leaves) {
    const auto found = FieldPath(one.path, false).find(tree.root());
    ASSERT_TRUE(found) << one.path;
    EXPECT_EQ(as_text(*found), as_text(one.field)) << one.path;
  }
}

TEST(Units, AreKnownByTheirSpellings) {
  const auto si = [](const char* name) { return unit_named(name)->si; };
  EXPECT_EQ(si("mm"), 1e-3);
  EXPECT_EQ(si("Inches"), 0.0254);
  EXPECT_DOUBLE_EQ(si("ft"), 0.3048);
  EXPECT_DOUBLE_EQ(si("degrees"), std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(si("rpm"), 2.0 * std::numbers::pi / 60.0);
  EXPECT_DOUBLE_EQ(si("km/h"), 1.0 / 3.6);
  EXPECT_EQ(si("\u00b5s"), 1e-6);
  EXPECT_EQ(si("\u03bcs"), 1e-6);
  EXPECT_FALSE(unit_named("furlong"));
}

TEST(Calendar, TimesAreNanosecondsSince1970) {
  EXPECT_EQ(calendar_time("1970-01-01T00:00:00"), 0);
  EXPECT_EQ(calendar_time("2000-03-01 00:00:00Z"), 951868800 * kSecond);  // after a leap day
  EXPECT_EQ(calendar_time("2026-03-01T12:30:00.25"), 1772368200 * kSecond + kSecond / 4);
  EXPECT_EQ(calendar_time("2026-03-01T12:30:00+01:30"), (1772368200 - 5400) * kSecond);
  for (const char* wrong : {"", "2026-02-30T00:00:00", "2026-01-01T24:00:00", "12:30:00",
                            "2026-01-01T00:00:00.1234567890"}) {
    EXPECT_FALSE(calendar_time(wrong)) << wrong;
  }
}

/// Radii of curvature along the meridian and across it (Rapp, 1991).
TEST(TangentPlane, IsTheGroundAroundItsOrigin) {
  constexpr double kA = 6378137.0;
  constexpr double kE2 = 0.00669437999014;
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const double latitude : {-60.0, 0.0, 42.5, 80.0}) {
    const double sin = std::sin(latitude * kDegree);
    const double root = std::sqrt(1.0 - kE2 * sin * sin);
    const double meridian = kA * (1.0 - kE2) / (root * root * root);
    const double across = kA / root * std::cos(latitude * kDegree);
    const TangentPlane plane(latitude, 8.0, 0.0);
    constexpr double kStep = 1e-4;  // deg: some ten metres
    const Vector2 at = plane.position(latitude + kStep, 8.0 + kStep, 0.0);
    EXPECT_NEAR(at.y(), meridian * kStep * kDegree, 2e-3);  // the parallel bends by so much
    EXPECT_NEAR(at.x(), across * kStep * kDegree, 2e-4);
    EXPECT_NEAR(plane.position(latitude, 8.0, 0.0).norm(), 0.0, 1e-9);
  }
}

FrameSample sample(double t, double x, double y, double angle) {
  FrameSample one;
  one.t = std::llround(t * static_cast<double>(kSecond));
  one.translation = {x, y, 0.0};
  one.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
  return one;
}

TEST(FrameTree, GoesOverTheCommonAncestorAndInterpolates) {
  FrameTree tree;
  EXPECT_TRUE(tree.add("map", "odom", sample(0, 1, 0, std::numbers::pi / 2), true));
  EXPECT_TRUE(tree.add("/odom", "/base_link", sample(0, 0, 0, 0), false));
  EXPECT_TRUE(tree.add("odom", "base_link", sample(2, 2, 0, 1.0), false));
  EXPECT_TRUE(tree.add("map", "tag.1", sample(0, 1, 3, 0), true));
  tree.sort();
  const auto base = tree.transform("map", "base_link", kSecond);
  ASSERT_TRUE(base);
  // Halfway, 1 m along odom's x axis, which is the map's y axis; turned by half of 1 rad.
  EXPECT_NEAR(base->translation().x(), 1.0, 1e-12);
  EXPECT_NEAR(base->translation().y(), 1.0, 1e-12);
  EXPECT_NEAR(planar_axis(base->rotation(), 'x').angle, std::numbers::pi / 2 + 0.5, 1e-12);
  const auto tag = tree.transform("base_link", "tag.1", kSecond);
  ASSERT_TRUE(tag);
  // The tag is 2 m ahead of odom's x direction; the robot is turned by 0.5 rad from there.
  EXPECT_NEAR(tag->translation().x(), 2.0 * std::cos(0.5), 1e-12);
  EXPECT_NEAR(tag->translation().y(), -2.0 * std::sin(0.5), 1e-12);
  EXPECT_FALSE(tree.transform("map", "base_link", 3 * kSecond)) << "never extrapolated";
  EXPECT_FALSE(tree.transform("map", "base_link", -1));
  EXPECT_FALSE(tree.are_joined("map", "nowhere"));
  EXPECT_EQ(tree.times("map", "base_link"), (std::vector<std::int64_t>{0, 2 * kSecond}));
  EXPECT_EQ(tree.times("base_link", "tag.1").size(), 2U);
  FrameSample none = sample(0, 0, 0, 0);
  none.rotation.coeffs().setZero();
  EXPECT_FALSE(tree.add("map", "x", none, true)) << "no rotation";
}

TEST(FrameTree, KeepsWhatIsAskedForAmongAMillionOthers) {
  FrameTree tree;
  tree.wants("tag*");
  tree.wants("base");
  tree.add("base", "camera", sample(0, 0.1, 0, 0), false);
  for (int k = 0; k < 1000000; ++k) {
    tree.add("base", "joint" + std::to_string(k % 7), sample(0.001 * k, 0, 0, 0), false);
    if (k % 1000 == 0) {
      tree.add("base", "camera", sample(0.001 * k, 0.1, 0, 0), false);
      tree.add("camera", "tag1", sample(0.001 * k, 1, 0, 0), false);
    }
  }
  tree.sort();
  EXPECT_EQ(tree.links().at("tag1").samples.size(), 1000U);
  EXPECT_EQ(tree.links().at("camera").samples.size(), 1000U);
  std::size_t others = 0;
  for (int j = 0; j < 7; ++j) others += tree.links().at("joint" + std::to_string(j)).samples.size();
  EXPECT_LT(others, 500000U);
}

TEST(FrameTree, NamesFitPatterns) {
  EXPECT_TRUE(is_like("tag36h11:5", "tag36h11:*"));
  EXPECT_TRUE(is_like("abc", "*"));
  EXPECT_TRUE(is_like("abcabd", "*abd"));
  EXPECT_FALSE(is_like("tag", "tag_*"));
  EXPECT_FALSE(is_like("abc", "ab"));
}

Signal signal_of(SignalMap::Kind kind, double wraps = 0.0) {
  SignalMap map;
  map.kind = kind;
  map.wraps = wraps;
  return Signal(map);
}

/// Sums over any intervals, against a fine grid.
TEST(Signal, SumsAreThoseOfEvenSpreading) {
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int64_t> step(5, 40);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  Signal rate = signal_of(SignalMap::Kind::rate);
  Signal per_row = signal_of(SignalMap::Kind::per_row);
  Signal sum = signal_of(SignalMap::Kind::cumulative);
  std::vector<double> per_tick;  // what is added in every ns * 1e6
  std::int64_t t = 0;
  double total = 0.0;
  rate.add(0, 0.0);
  per_row.add(0, 0.0);
  sum.add(0, 0.0);
  while (per_tick.size() < 2000) {
    const std::int64_t ticks = step(random);
    const double added = value(random);
    t += ticks;
    total += added;
    rate.add(t * 1000000, added / (static_cast<double>(ticks) * 1e-3));
    per_row.add(t * 1000000, added);
    sum.add(t * 1000000, total);
    per_tick.insert(per_tick.end(), static_cast<std::size_t>(ticks),
                    added / static_cast<double>(ticks));
  }
  for (Signal* one : {&rate, &per_row, &sum}) one->finish();
  for (std::int64_t from = 0; from + 60 < 2000;) {
    const std::int64_t to = from + step(random);
    double expected = 0.0;
    for (std::int64_t k = from; k < to; ++k) expected += per_tick[static_cast<std::size_t>(k)];
    for (Signal* one : {&rate, &per_row, &sum}) {
      EXPECT_NEAR(one->sum(from * 1000000, to * 1000000), expected, 1e-12);
    }
    from = to;
  }
}

TEST(Signal, CountersThatBeginAgainGoOn) {
  for (const int step : {-30000, -7, 11, 30000}) {
    Signal counter = signal_of(SignalMap::Kind::cumulative, 65536.0);
    std::int64_t count = 0;
    for (int k = 0; k < 50; ++k, count += step) {
      counter.add(k, static_cast<double>(((count % 65536) + 65536) % 65536));
    }
    counter.finish();
    for (int k = 0; k + 1 < 50; ++k) EXPECT_EQ(counter.sum(k, k + 1), step);
  }
}

TEST(Signal, SortsAndCountsWhatIsOutOfOrder) {
  Signal sum = signal_of(SignalMap::Kind::cumulative);
  for (const std::int64_t t : {0, 2, 1, 3, 3}) sum.add(t, 10.0 * static_cast<double>(t));
  sum.add(3, 31.0);
  sum.finish();
  EXPECT_EQ(sum.times(), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(sum.unordered(), 1U);
  EXPECT_EQ(sum.repeated(), 2U);
  EXPECT_EQ(sum.level(3), 31.0) << "of equal times the last";
}

TEST(Signal, WhatIsWrittenOnChangeHeldUntilACycleBefore) {
  SignalMap map;
  map.kind = SignalMap::Kind::cumulative;
  map.on_change = 0.02;
  Signal sum(map);
  sum.add(0, 1.0);
  sum.add(kSecond, 2.0);
  sum.finish();
  EXPECT_EQ(sum.level(kSecond - kSecond / 50), 1.0);
  EXPECT_NEAR(sum.level(kSecond - kSecond / 100), 1.5, 1e-12);
}

TEST(Signal, ClocksAreSet) {
  SignalMap map;
  map.kind = SignalMap::Kind::level;
  map.clock = -0.25;
  map.scale = 2.0;
  map.offset = 1.0;
  Signal level(map);
  level.add(kSecond, 3.0);
  level.finish();
  EXPECT_EQ(level.times().front(), kSecond - kSecond / 4);
  EXPECT_EQ(level.values().front(), 7.0);
}

}  // namespace
}  // namespace trussmap::log_pieces_test
