// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps from simulated recordings: what further sessions add, and what ties them to the map.
#include "trussmap/build_map.hpp"

#include "simulation/wheeled_robot.hpp"
#include "trussmap/error.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::build_map_test {
namespace {

/// Two tours of a 4x4 mesh.
Recording drive_about(bool compass, std::uint64_t seed) {
  const Mesh mesh = even_mesh({4, 4}, 5.0);
  auto random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.compass = compass;
  Recording recording = simulate_drive(mesh, tours.walk, {}, robot, seed).recording;
  recording.survey = simulation::survey(mesh, 1e-6, seed);
  return recording;
}

/// A lorry may be that wide, but no more.
TEST(BuildMap, AWheelbaseBeyondTenMetresIsDoubted) {
  const Mesh mesh = even_mesh({2, 2}, 30.0);
  for (const double wheelbase : {9.9, 10.1}) {
    WheeledRobot robot;
    robot.geometry.wheelbase = wheelbase;
    Model model;
    model.robot.wheelbase = wheelbase;
    const Recording recording = simulate_drive(mesh, {0, 1, 3, 2, 0}, {}, robot, 5).recording;
    const BuiltMap built = build_map({recording}, model);
    const bool doubted = std::any_of(
        built.warnings.begin(), built.warnings.end(),
        [](const std::string& one) { return one.find("is it in metres?") != std::string::npos; });
    EXPECT_EQ(doubted, wheelbase > 10.0) << wheelbase;
  }
}

/// The recording from the given sighting on, as a session of its own.
Recording from_sighting(const Recording& whole, std::size_t first) {
  const double t = whole.sightings[first].t;
  Recording part = whole;
  part.name = "part";
  part.sightings.erase(part.sightings.begin(),
                       part.sightings.begin() + static_cast<std::ptrdiff_t>(first));
  const auto row = std::upper_bound(whole.drive.t.begin(), whole.drive.t.end(), t + 1e-9) -
                   whole.drive.t.begin();
  const auto cut = [row](std::vector<double>& column) {
    if (!column.empty()) column.erase(column.begin(), column.begin() + row);
  };
  cut(part.drive.t);
  cut(part.drive.left);
  cut(part.drive.right);
  cut(part.drive.heading);
  for (Covariate& one : part.drive.covariates) cut(one.values);
  return part;
}

Recording up_to_sighting(Recording whole, std::size_t last) {
  whole.sightings.resize(last + 1);
  return whole;
}

double error_of(const BuiltMap& result, const Recording& surveyed) {
  return compare_with_survey(positions_of(result.map), surveyed.survey).rigid.rms;
}

class Sessions : public ::testing::TestWithParam<bool> {};

/// A session that wakes up in the midst of the map, looking anywhere, is worth as much as the same
/// drive without the interruption (seeds 1 to 5; both maps' errors are of one size).
TEST_P(Sessions, AnInterruptedDriveGivesAsGoodAMap) {
  double whole_sum = 0.0;
  double parts_sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Recording whole = drive_about(GetParam(), seed);
    for (const std::size_t cut : {30U, 41U}) {  // the first tour has 32 legs
      const Recording again = from_sighting(whole, cut);
      whole_sum += error_of(build_map({whole}, Model{}), whole);
      parts_sum += error_of(build_map({up_to_sighting(whole, cut), again}, Model{}), whole);
    }
  }
  EXPECT_LE(parts_sum, 1.3 * whole_sum);
  EXPECT_LE(parts_sum / 10.0, 0.2);  // m
}

INSTANTIATE_TEST_SUITE_P(Compass, Sessions, ::testing::Values(false, true));

/// A robot that starts where no landmark of the map is begins at the first one it meets.
TEST(BuildMap, ASessionThatStartsElsewhereJoinsWhereItMeetsTheMap) {
  const Recording whole = drive_about(false, 7);
  Recording elsewhere = from_sighting(whole, 20);
  elsewhere.sightings.front().landmark = "never seen before";
  const BuiltMap joined = build_map({up_to_sighting(whole, 32), elsewhere}, Model{});
  EXPECT_LE(error_of(joined, whole), 0.2);
}

TEST(BuildMap, ASessionThatMeetsNothingOfTheMapIsTiedToNothing) {
  const Recording whole = drive_about(false, 8);
  Recording foreign = whole;
  foreign.name = "abroad";
  for (Sighting& sighting : foreign.sightings) sighting.landmark += " abroad";
  try {
    (void)build_map({whole, foreign}, Model{});
    FAIL();
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("abroad stands apart: no landmark ties it to"),
              std::string::npos)
        << error.what();
  }
}

/// Where one session has a compass the map's +x axis is the compass's, whoever comes first.
TEST(BuildMap, TheCompassGivesTheDirection) {
  Recording with = drive_about(true, 9);
  for (double& reading : with.drive.heading) reading += 1.0;  // the mesh lies askew to its north
  const Recording without = drive_about(false, 10);
  const BuiltMap result = build_map({without, with}, Model{});
  const Alignment laid = compare_with_survey(positions_of(result.map), with.survey).rigid;
  EXPECT_NEAR(laid.angle, -1.0, 0.05);
}

TEST(BuildMap, RefusesARecordingWithoutSightings) {
  Recording nothing = drive_about(true, 11);
  nothing.sightings.clear();
  EXPECT_THROW((void)build_map({nothing}, Model{}), InputError);
  EXPECT_THROW((void)build_map(std::vector<Recording>(), Model{}), std::invalid_argument);
}

MapBuilder grown_by(const std::vector<Recording>& recordings, MapAxes axes, Method method) {
  MapBuilder builder({.method = method});
  for (const Recording& one : recordings) (void)extend_map(builder, one, Model{}, axes);
  return builder;
}

double error_of(const MapBuilder& builder, const Recording& surveyed) {
  BuiltMap built;
  built.map = builder.map();
  return error_of(built, surveyed);
}

/// The first session makes the map that build_map makes by the same method; each further one is
/// turned into its axes, whatever way its own point, and makes it no worse.
TEST(ExtendMap, SessionsOneByOne) {
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    const Recording first = drive_about(true, 21);
    const BuiltMap alone = build_map({first}, Model{}, {.method = method});
    MapBuilder builder = grown_by({first}, MapAxes::compass, method);
    EXPECT_NEAR(error_of(builder, first), error_of(alone, first), 1e-9);

    Recording askew = drive_about(true, 22);
    for (double& reading : askew.drive.heading) reading += 0.7;  // a compass of another country
    const BuiltMap second = extend_map(builder, askew, Model{}, MapAxes::landmarks);
    EXPECT_TRUE(second.extended);
    EXPECT_EQ(second.new_landmarks, 0);
    const BuiltMap third = extend_map(builder, drive_about(false, 23), Model{}, MapAxes::compass);
    EXPECT_TRUE(third.good());
    EXPECT_LE(error_of(builder, first), 1.3 * error_of(alone, first));
    const Alignment laid = compare_with_survey(positions_of(builder.map()), first.survey).rigid;
    EXPECT_NEAR(laid.angle, 0.0, 0.01);  // still the first compass's
  }
}

/// Two common landmarks that all but coincide turn nothing.
TEST(ExtendMap, WhatCannotBeTurnedIsRefused) {
  MapBuilder builder = grown_by({drive_about(true, 27)}, MapAxes::compass, Method::gauss_markov);
  Recording apart = drive_about(false, 28);
  Recording one_only = apart;
  for (Sighting& one : apart.sightings) {
    if (one.landmark == "L0_1") one.landmark = "L0_0 beside";
    if (one.landmark != "L0_0") one.landmark += " abroad";
  }
  EXPECT_THROW((void)extend_map(builder, apart, Model{}, MapAxes::compass), SolveError);
  builder.start("L0_0");
  builder.observe("close", Traversal{{0.02, 0.0}, 1e-6 * Matrix2::Identity()});
  for (Sighting& one : one_only.sightings) {
    if (one.landmark == "L0_1")
      one.landmark = "close";
    else if (one.landmark != "L0_0")
      one.landmark += " abroad";
  }
  EXPECT_THROW((void)extend_map(builder, one_only, Model{}, MapAxes::compass), SolveError);
}

/// What moved is named, and the map is not drawn after it.
TEST(ExtendMap, ALandmarkThatHasMovedIsNamed) {
  const Recording first = drive_about(true, 29);
  for (const bool compass : {true, false}) {
    MapBuilder builder = grown_by({first}, MapAxes::compass, Method::gauss_markov);
    const Vector2 before = builder.position(*builder.find("L1_2"));
    Recording moved = drive_about(compass, 30);
    for (Sighting& one : moved.sightings) {
      if (one.landmark == "L1_2") {
        one.landmark = "L1_1";
      } else if (one.landmark == "L1_1") {
        one.landmark = "L1_2";
      }
    }
    const BuiltMap built = extend_map(builder, moved, Model{}, MapAxes::compass);
    EXPECT_FALSE(built.good());
    EXPECT_FALSE(built.off_map.empty());
    EXPECT_NE(built.warnings.front().find("L1_2"), std::string::npos) << built.warnings.front();
    EXPECT_LE((builder.position(*builder.find("L1_2")) - before).norm(), 0.2);
  }
}

TEST(ExtendMap, ASessionElsewhereIsRefusedOrDoubted) {
  MapBuilder builder = grown_by({drive_about(true, 24)}, MapAxes::compass, Method::gauss_markov);
  Recording nowhere = drive_about(false, 25);
  for (Sighting& one : nowhere.sightings) one.landmark += " abroad";
  EXPECT_THROW((void)extend_map(builder, nowhere, Model{}, MapAxes::compass), SolveError);
  Recording mirrored = drive_about(true, 26);
  for (Sighting& one : mirrored.sightings) {  // L2_1 is where L1_2 was
    std::swap(one.landmark[1], one.landmark[3]);
  }
  const BuiltMap doubted = extend_map(builder, mirrored, Model{}, MapAxes::compass);
  EXPECT_FALSE(doubted.good());
}

}  // namespace
}  // namespace trussmap::build_map_test
