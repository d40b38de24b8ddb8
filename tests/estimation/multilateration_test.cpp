// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Beacons by ranges alone: against a fine grid, the mirror, and whole recordings.
#include "estimation/multilateration.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::multilateration_test {
using namespace estimation;
namespace {

std::vector<RangeReading> readings_of(const Vector2& beacon, const std::vector<Vector2>& path,
                                      double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<RangeReading> readings;
  for (const Vector2& q : path)
    readings.push_back({q, (beacon - q).norm() + normal(random), noise});
  return readings;
}

std::vector<Vector2> line(const Vector2& from, const Vector2& to, int count) {
  std::vector<Vector2> path;
  for (int k = 0; k < count; ++k) path.push_back(from + (to - from) * k / (count - 1.0));
  return path;
}

/// Of squares up to two standard deviations, and linear from there.
double sum_at(const std::vector<RangeReading>& readings, const Vector2& p) {
  double sum = 0.0;
  for (const RangeReading& one : readings) {
    const double z = std::abs((p - one.from).norm() - one.range) / one.sd;
    sum += z <= 2.0 ? z * z : 4.0 * z - 4.0;
  }
  return sum;
}

/// The least sum, by looking everywhere, 2 cm apart round the truth.
double least_by_grid(const std::vector<RangeReading>& readings, const Vector2& middle) {
  double least = sum_at(readings, middle);
  for (int i = -60; i <= 60; ++i) {
    for (int j = -60; j <= 60; ++j) {
      least = std::min(least, sum_at(readings, middle + 0.02 * Vector2(i, j)));
    }
  }
  return least;
}

TEST(Multilateration, IsTheBestPlaceThereIs) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> anywhere(-30.0, 30.0);
  std::vector<Vector2> path = line({0.0, 0.0}, {15.0, 2.0}, 40);
  for (const Vector2& q : line({15.0, 2.0}, {10.0, 14.0}, 30)) path.push_back(q);
  for (int round = 0; round < 20; ++round) {
    const Vector2 beacon(anywhere(random), anywhere(random));
    const auto readings = readings_of(beacon, path, 0.1, random);
    const auto found = multilaterate(readings);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->certain) << beacon.transpose();
    EXPECT_LE(sum_at(readings, found->place), least_by_grid(readings, beacon) + 1e-6);
    EXPECT_LE((found->place - beacon).norm(), 0.5) << beacon.transpose();
  }
}

TEST(Multilateration, FromOneLineThereAreTwoPlaces) {
  std::mt19937_64 random(42);
  const auto readings = readings_of({8.0, 5.0}, line({0.0, 0.0}, {20.0, 0.0}, 50), 0.1, random);
  const auto found = multilaterate(readings);
  ASSERT_TRUE(found && found->mirror);
  EXPECT_FALSE(found->certain);
  const double up = std::max(found->place.y(), found->mirror->y());
  const double down = std::min(found->place.y(), found->mirror->y());
  EXPECT_NEAR(up, 5.0, 0.15);
  EXPECT_NEAR(down, -5.0, 0.15);
}

TEST(Multilateration, AThirdOfWrongRangesDoesNotMoveIt) {
  std::mt19937_64 random(43);
  std::vector<Vector2> path = line({0.0, 0.0}, {15.0, 2.0}, 40);
  for (const Vector2& q : line({15.0, 2.0}, {10.0, 14.0}, 30)) path.push_back(q);
  auto readings = readings_of({-6.0, 9.0}, path, 0.05, random);
  for (std::size_t k = 0; k < readings.size(); k += 4) readings[k].range += 8.0;
  const auto found = multilaterate(readings);
  ASSERT_TRUE(found);
  EXPECT_LE((found->place - Vector2(-6.0, 9.0)).norm(), 0.3);
}

TEST(Multilateration, TakesThree) {
  EXPECT_FALSE(multilaterate({{{0.0, 0.0}, 1.0, 0.1}, {{1.0, 0.0}, 1.0, 0.1}}));
}

/// What a robot with a range sensor records, its bearings and stops taken away.
DrivenRecording ranges_alone(std::uint64_t seed, bool compass) {
  DrivenRecording recording =
      testing::simulate_recording({.compass = compass, .range_sensor = true}, seed).recording;
  std::erase_if(recording.sightings, [](const Sighting& one) { return one.standing(); });
  for (Sighting& one : recording.sightings) one.bearing = kAbsent;
  return recording;
}

/// Maps are as good as their standard errors say, chi^2 is as large as there are degrees of
/// freedom.
TEST(RangesAlone, MakeAMap) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const DrivenRecording recording = ranges_alone(seed, seed % 2 == 0);
    const BuiltMap built = build_map({recording}, testing::simulate_recording({}, 1).model);
    ASSERT_TRUE(built.on_survey);
    EXPECT_EQ(built.legs, 0);
    EXPECT_LE(built.on_survey->comparison.rigid.rms, 4.0 * built.quality.median_sd) << seed;
    EXPECT_TRUE(std::isnan(built.on_survey->rms_dead_reckoning));
    chi2 += built.fit.chi2;
    dof += built.fit.dof;
  }
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

/// A drive straight past a beacon 5 m to its left, and two landmarks that range and
/// bearing place.
DrivenRecording past_a_beacon(SensorParts parts) {
  DrivenRecording recording;
  recording.name = "past a beacon";
  for (int k = 1; k <= 100; ++k) {
    recording.drive.t.push_back(0.5 * k);
    testing::add_travels(recording.drive, 0.2, 0.2);
    if (k % 4 != 0) continue;
    const Vector2 robot(0.2 * k, 0.0);
    const Vector2 beacon = Vector2(9.0, 5.0) - robot;
    recording.sightings.push_back(
        {0.5 * k, "beacon", parts != SensorParts::bearing_alone ? beacon.norm() : kAbsent,
         parts != SensorParts::range_alone ? direction(beacon) : kAbsent});
    for (const double x : {3.0, 16.0}) {
      const Vector2 other = Vector2(x, 2.0) - robot;
      recording.sightings.push_back(
          {0.5 * k, x < 9.0 ? "first" : "second", other.norm(), direction(other)});
    }
  }
  return recording;
}

bool say_the_mirror(const std::vector<std::string>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(), [](const std::string& one) {
    return one.starts_with(
        "landmark beacon has ranges from about one line alone: it may as well lie at (");
  });
}

TEST(RangesAlone, OneLineIsSaid) {
  const DrivenRecording recording = past_a_beacon(SensorParts::range_alone);
  EXPECT_TRUE(say_the_mirror(fit_model({recording}, Model{}).warnings));
  EXPECT_TRUE(say_the_mirror(build_map({recording}, Model{}).warnings));
}

TEST(RangesAlone, ABearingTellsTheSide) {
  for (const SensorParts parts : {SensorParts::both, SensorParts::bearing_alone}) {
    const DrivenRecording recording = past_a_beacon(parts);
    EXPECT_FALSE(say_the_mirror(fit_model({recording}, Model{}).warnings));
    EXPECT_FALSE(say_the_mirror(build_map({recording}, Model{}).warnings));
  }
}

}  // namespace
}  // namespace trussmap::multilateration_test
